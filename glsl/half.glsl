// Halves by integer operations: unpackHalf2x16 takes software GL a third of a texel's fetch for each of its two.

// What halves_of makes of infinity.
const float kHalfInfinity = 65536.0;

// unpackHalf2x16, but for 0 below 6.1e-5: the bits of a half stand where a float has its own, with the exponent 2^-112 times as large.
vec2 halves_of(uint bits) {
    uvec2 floats = uvec2((bits & 0x8000u) << 16 | (bits & 0x7fffu) << 13, (bits & 0x80000000u) | (bits & 0x7fff0000u) >> 3);
    return uintBitsToFloat(floats) * 5.192296858534828e33;  // 2^112
}

// The nearest half, of two the even one.
float as_half(float value) {
    uint bits = floatBitsToUint(value);
    return uintBitsToFloat((bits + 0xfffu + (bits >> 13 & 1u)) & 0xffffe000u);
}
