// The part of a pixel's light that blooms, and of its alpha: premultiplied colour is scaled as a whole.
vec4 bright_part(vec4 texel) {
    if (any(isnan(texel)) || any(isinf(texel))) return vec4(0.0);
    if (param.threshold == 0.0) return texel;
    float light = max(texel.r, max(texel.g, texel.b));
    // A parabola joins 0 and the straight line within threshold -+ knee.
    float knee = param.threshold * param.knee;
    float soft = clamp(light - param.threshold + knee, 0.0, 2.0 * knee);
    float passed = max(light - param.threshold, knee > 0.0 ? soft * soft / (4.0 * knee) : 0.0);
    return passed > 0.0 ? texel * (passed / light) : vec4(0.0);
}
