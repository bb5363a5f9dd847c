// Chromatic adaptation from the light that looks neutral to the light that does at the defaults.

const float kNeutralKelvin = 6500.0;

// CIE 1960 uv of a black body: Krystek 1985, within 8e-5 from 1000 to 15000 K.
vec2 planckian_uv(float kelvin) {
    float t = kelvin, t2 = kelvin * kelvin;
    return vec2((0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t2) / (1.0 + 8.42420235e-4 * t + 7.08145163e-7 * t2),
                (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t2) / (1.0 - 2.89741816e-5 * t + 1.61456053e-7 * t2));
}

// CIE XYZ, Y = 1, of a light off the locus by `tint`; positive is greener.
vec3 white_xyz(float kelvin, float tint) {
    vec2 uv = planckian_uv(kelvin);
    vec2 along = normalize(planckian_uv(kelvin * 1.01) - planckian_uv(kelvin * 0.99));
    // Towards blue the locus falls in u: its normal with a positive v points to green.
    uv += vec2(along.y, -along.x) * (tint / 3000.0);
    vec2 xy = vec2(3.0 * uv.x, 2.0 * uv.y) / (2.0 * uv.x - 8.0 * uv.y + 4.0);
    return vec3(xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y);
}

// Matrices by columns. Rec. 709: ITU-R BT.709-6 primaries with D65.
const mat3 kXyzFromRec709 = mat3(0.4123908, 0.2126390, 0.0193308, 0.3575843, 0.7151687, 0.1191948, 0.1804808, 0.0721923,
                                 0.9505322);
const mat3 kBradfordFromXyz = mat3(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296);

vec3 balanced(vec3 rec709, float kelvin, float tint) {
    vec3 from = kBradfordFromXyz * white_xyz(kelvin, tint);
    vec3 to = kBradfordFromXyz * white_xyz(kNeutralKelvin, 0.0);
    mat3 cone_from_rec709 = kBradfordFromXyz * kXyzFromRec709;
    return inverse(cone_from_rec709) * (cone_from_rec709 * rec709 * (to / from));
}
