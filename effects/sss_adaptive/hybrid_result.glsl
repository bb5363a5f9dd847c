// Samples and blurs in one.
vec3 hybrid_result(ivec2 p, vec3 drawn) {
    float share = texelFetch(sampled, p, 0).r, scattered = texelFetch(plan, p, 0).z;
    vec3 light = texelFetch(surface, p, 0).rgb, smooth_light = texelFetch(blurred, p, 0).rgb;
    if (scattered < 1.0) smooth_light = scattered == 0.0 ? light : mix(light, smooth_light, scattered);
    return share == 1.0 ? drawn : share == 0.0 ? smooth_light : mix(smooth_light, drawn, share);
}
