// The part of a pixel's light that blooms, and of its alpha: premultiplied colour is scaled as a whole.

// By the bits, because the exponent of all that is no number has every bit set: on llvmpipe isnan() and isinf() take more than
// twice the operations.
bool is_finite(vec4 texel) {
    ivec4 size = floatBitsToInt(texel) & 0x7FFFFFFF;
    return max(max(size.r, size.g), max(size.b, size.a)) < 0x7F800000;
}

// llvmpipe computes both sides of every branch: this one returns a factor, which is a quarter of a texel.
float bright_share(vec4 texel) {
    float light = max(texel.r, max(texel.g, texel.b));
    // A parabola joins 0 and the straight line within threshold -+ knee.
    float knee = param.threshold * param.knee;
    float soft = clamp(light - param.threshold + knee, 0.0, 2.0 * knee);
    float passed = max(light - param.threshold, knee > 0.0 ? soft * soft / (4.0 * knee) : 0.0);
    float share = passed > 0.0 ? passed / light : 0.0;
    return param.threshold == 0.0 ? 1.0 : share;
}

vec4 bright_part(vec4 texel) { return is_finite(texel) ? texel * bright_share(texel) : vec4(0.0); }
