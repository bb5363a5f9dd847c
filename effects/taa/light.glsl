// Light in the space where it is compared: YCoCg and alpha, and with HDR_WEIGHTING as its weight makes it.

float luma(vec3 rgb) { return dot(rgb, vec3(0.25, 0.5, 0.25)); }

// Karis 2014: a mean by these weights is the mean of compressed light, expanded.
float weight_of(vec4 light) {
#if HDR_WEIGHTING
    return 1.0 / (1.0 + max(luma(light.rgb), 0.0));
#else
    return 1.0;
#endif
}

vec4 compared(vec4 light) {
    light *= weight_of(light);
    return vec4(luma(light.rgb), 0.5 * (light.r - light.b), luma(vec3(-light.r, light.g, -light.b)), light.a);
}

// The inverse. Luma below 1 - least_weight keeps rounding from dividing by nothing.
vec4 light_of(vec4 c, float least_weight) {
    vec4 light = vec4(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z, c.w);
#if HDR_WEIGHTING
    light /= max(1.0 - max(c.x, 0.0), least_weight);
#endif
    return light;
}
