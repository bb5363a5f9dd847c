// In two bytes of textures, because llvmpipe fetches texels of four bytes six times as fast as those of four words: steps of
// 0.0002 standard deviations.
const float kMostDeviations = 6.0;

// Of sums of bytes, each times a weight, and the sum of the weights.
vec3 grain_of_bytes(vec3 high, vec3 low, float weights) {
    return 2.0 * kMostDeviations * ((256.0 * 255.0 / 65535.0) * high + (255.0 / 65535.0) * low) - kMostDeviations * weights;
}
