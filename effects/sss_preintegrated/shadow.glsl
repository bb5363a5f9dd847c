// Shadows between passes, one texel of four words.

// Of one pixel.
struct Shadow {
    vec3 seen;      // share of the lights' light that arrives: 0 in shadow, 1 out of it, at most kMostSeen
    float trust;    // 0 where it cannot be told
    float depth_m;
    uint key;       // as key_at() has it
};

const float kMostSeen = 4.0;  // more than the lights themselves: a pattern's crests, lights that are not known

vec3 seen_share(vec3 irradiance, vec3 unshadowed) {
    vec3 light = max(irradiance - param.ambient, 0.0);
    return mix(vec3(1.0), min(light / max(unshadowed, 1e-20), kMostSeen), greaterThan(unshadowed, vec3(1e-20)));
}

uvec4 packed_shadow(Shadow shadow) {
    return uvec4(packHalf2x16(shadow.seen.rg), packHalf2x16(vec2(shadow.seen.b, shadow.trust)),
                 floatBitsToUint(shadow.depth_m), shadow.key);
}
Shadow unpacked_shadow(uvec4 texel) {
    vec2 low = unpackHalf2x16(texel.x), high = unpackHalf2x16(texel.y);
    return Shadow(vec3(low, high.x), high.y, uintBitsToFloat(texel.z), texel.w);
}

// The least and the most share around a pixel, in steps of 1 / 255, so that 0 and 1 are exact.
uint packed_least(vec3 share) {
    uvec3 at = uvec3(clamp(floor(share * 255.0), 0.0, 1023.0));
    return at.r | at.g << 10 | at.b << 20;
}
uint packed_most(vec3 share) {
    uvec3 at = uvec3(clamp(ceil(share * 255.0), 0.0, 1023.0));
    return at.r | at.g << 10 | at.b << 20;
}
vec3 unpacked_share(uint word) { return vec3(word & 1023u, word >> 10 & 1023u, word >> 20 & 1023u) / 255.0; }

// Weights of 0 to 1, for each channel.
uint packed_weight(vec3 weight) {
    uvec3 at = uvec3(clamp(weight * 1023.0 + 0.5, 0.0, 1023.0));
    return at.r | at.g << 10 | at.b << 20;
}
vec3 unpacked_weight(uint word) { return vec3(word & 1023u, word >> 10 & 1023u, word >> 20 & 1023u) / 1023.0; }

// Standard deviations of the blur that widens shadows, mm, and how far it goes. Twice d: 4.3 deviations away the edge
// response has come within 0.9 % of its end, and the blurred shadow, 8e-6 from its own, can still tell the place.
const float kCut = 4.3;
vec3 blur_sigma_mm(vec3 d, float pixels_per_mm) {
    return min(2.0 * d, float(param.max_shadow_radius) / (kCut * pixels_per_mm));
}
