#version 450 core
#include <pass>

// The spectrum goes from -1, blue, over 0, green, to 1, red: at a place t > 0 it has t of red and 1 - t of green, at -t as
// much of blue and green. They sum to 1 everywhere, so that white stays white.
float spectral_place(int tap) { return 2.0 * float(tap) / float(param.taps - 1) - 1.0; }

int first_red() { return (param.taps + 1) / 2; }

// Of the places above 0 the sums of their first to third powers, in closed form: they are 1/m, 2/m, ... 1 where one place is 0, else
// 1/d, 3/d, ... 1 with d = 2 m - 1.
vec3 red_moments() {
    float m = float(param.taps - first_red()), d = 2.0 * m - 1.0;
    vec3 whole = (m + 1.0) / m * vec3(0.5 * m, (2.0 * m + 1.0) / 6.0, 0.25 * (m + 1.0));
    vec3 odd = m / d * vec3(m, (2.0 * m + 1.0) / 3.0, m * (2.0 * m * m - 1.0) / (d * d));
    return (param.taps & 1) == 1 ? whole : odd;
}

// Along the ray, light between four texels is a polynomial of degree 2: the pixel itself and the places 0.5 and 1 give the sum
// over any number of places, weighted so that the sums of their powers 0, 1 and 2 are `moments`.
vec3 three_places(vec3 moments) {
    return vec3(moments.x - 3.0 * moments.y + 2.0 * moments.z, 4.0 * (moments.y - moments.z), 2.0 * moments.z - moments.y);
}

void main() {
    vec4 own = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    if (param.amount == 0.0) {
        out_color = own;
        return;
    }
    vec2 half_size_px = 0.5 * vec2(frame.display_size);
    vec2 from_centre_px = gl_FragCoord.xy + vec2(frame.origin) - half_size_px;
    // Squared, of the distance to a corner.
    float distance2 = dot(from_centre_px, from_centre_px) / dot(half_size_px, half_size_px);
    vec3 red = red_moments();
    // How much larger than green's the picture of the spectrum's place 1 is. The mean place of red is brought to 1, so that
    // `amount` is what is measured between the channels.
    float magnified = param.amount * (red.x / red.y) / length(half_size_px) * pow(distance2, 0.5 * (param.falloff - 1.0));
    vec2 centre = (gl_FragCoord.xy - from_centre_px) * color_size.zw, ray = from_centre_px * color_size.zw;
    bool has_middle = (param.taps & 1) == 1;
    vec4 sum = has_middle ? vec4(0.0, own.g, 0.0, own.a) : vec4(0.0);
    // All taps of a side lie between the same four texels. The places of a magnified picture are even but for the square of the
    // magnification, of which 0.005 leaves too little to see.
    int count = param.taps - first_red();
    float largest = abs(magnified);
    vec2 reach_px = abs(from_centre_px) * largest / max(1.0 - largest, 0.1);
    bool is_within_texels = count > 2 && largest < 0.005 && max(reach_px.x, reach_px.y) <= 1.0;
    vec3 red_weights = three_places(red), all_weights = three_places(vec3(float(count), red.xy));
    if (is_within_texels)
        sum += vec4(red_weights.x, 2.0 * (all_weights.x - red_weights.x), red_weights.x, 2.0 * all_weights.x) * own;
    int turn = 0, turns = is_within_texels ? 2 : count;
    do {
        float place = is_within_texels ? 0.5 * float(turn + 1) : spectral_place(first_red() + turn);
        float larger = place * magnified, red_weight = place, weight = 1.0;
        if (is_within_texels) {
            red_weight = turn == 0 ? red_weights.y : red_weights.z;
            weight = turn == 0 ? all_weights.y : all_weights.z;
        }
        // What a lens magnifies was nearer to the centre. The bound holds off the pole of absurd amounts.
        vec4 outer = textureLod(color, centre + ray / max(1.0 + larger, 0.1), 0.0);
        vec4 inner = textureLod(color, centre + ray / max(1.0 - larger, 0.1), 0.0);
        sum.r += red_weight * outer.r;
        sum.b += red_weight * inner.b;
        sum.ga += vec2(weight - red_weight, weight) * (outer.ga + inner.ga);
    } while (++turn < turns);
    out_color = sum / vec4(red.x, float(param.taps) - 2.0 * red.x, red.x, float(param.taps));
}
