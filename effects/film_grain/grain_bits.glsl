// Grains in 16 bits for each channel, in steps of 0.0002 standard deviations. They lie in textures of one word a texel, because
// llvmpipe fetches such a texel six times as fast as one of four words, and bits of a word faster than bytes of rgba8.
const float kMostDeviations = 6.0;
const float kGreatestCode = 65535.0;

// Red and green, and blue; if monochrome, red alone.
uvec2 grain_bits(vec3 grain) {
    ivec3 code = ivec3((grain + kMostDeviations) * (kGreatestCode / (2.0 * kMostDeviations)) + 0.5);
#if MONOCHROME
    return uvec2(code.r, 0);
#else
    return uvec2(code.r | code.g << 16, code.b);
#endif
}

// Signed on the way, because llvmpipe converts unsigned integers to floats in more operations.
vec3 grain_codes(uvec2 bits) {
#if MONOCHROME
    return vec3(int(bits.x));
#else
    return vec3(ivec3(bits.x & 0xFFFFu, bits.x >> 16u, bits.y));
#endif
}

// Of a sum of codes, each times a weight, and the sum of the weights.
vec3 grain_of_codes(vec3 codes, float weights) {
    return (2.0 * kMostDeviations / kGreatestCode) * codes - kMostDeviations * weights;
}
