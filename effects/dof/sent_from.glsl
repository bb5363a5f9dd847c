// Where light in front of a pixel comes from, as a float that is the greater the more light it is: the 13 bits of its logarithm above
// two offsets of 9 bits, px. Blended by max, the texture keeps the place that sends most.
const int kFurthestPx = 255;

float pack_sent(float light, vec2 offset_px) {
    uint strength = uint(clamp(32.0 * log2(max(light, 1e-12)) + 1350.0, 32.0, 8000.0));  // at least 32: no denormal float
    uvec2 places = uvec2(ivec2(clamp(round(offset_px), vec2(-kFurthestPx), vec2(kFurthestPx))) + kFurthestPx + 1);
    return uintBitsToFloat(strength << 18 | places.y << 9 | places.x);
}

// 0 where nothing was sent.
vec2 sent_offset_px(float packed_place) {
    uint bits = floatBitsToUint(packed_place);
    return bits == 0u ? vec2(0.0) : vec2(ivec2(bits & 511u, bits >> 9 & 511u) - kFurthestPx - 1);
}
