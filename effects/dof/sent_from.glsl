// Where light in front of a pixel comes from, as a float that is the greater the more light it is: the 14 bits of its logarithm above
// two offsets of 8 bits, px. Blended by max, the texture keeps the place that sends most.
const int kFurthestPx = 127;

float pack_sent(float light, vec2 offset_px) {
    uint strength = uint(clamp(64.0 * log2(max(light, 1e-12)) + 2700.0, 128.0, 16000.0));  // at least 128: no denormal float
    uvec2 places = uvec2(ivec2(clamp(round(offset_px), vec2(-kFurthestPx), vec2(kFurthestPx))) + kFurthestPx + 1);
    return uintBitsToFloat(strength << 16 | places.y << 8 | places.x);
}

// 0 where nothing was sent.
vec2 sent_offset_px(float packed_place) {
    uint bits = floatBitsToUint(packed_place);
    return bits == 0u ? vec2(0.0) : vec2(ivec2(bits & 255u, bits >> 8 & 255u) - kFurthestPx - 1);
}
