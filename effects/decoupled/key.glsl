// What a visibility sample keeps of the nearest shading sample, so that the smallest number is the nearest: depth comes first, then
// the layer and the way from the shading sample to the pixel. Of a picture alone, estimates come after all that was captured.
const uint kEmpty = 0xffffffffu;
const uint kEstimate = 0x80000000u;
const float kLevels = 2046.0;
const int kEstimatedLayer = 3;  // where the capture has no fourth layer
const int kFurthestPx = 255;
const int kBandSamples = 64;

uint level_of(float depth_m, vec2 range_log2) {
    if (isinf(depth_m) || !(depth_m > 0.0)) return 2047u;
    float part = (log2(depth_m) - range_log2.x) / max(range_log2.y - range_log2.x, 1e-6);
    return uint(clamp(part, 0.0, 1.0) * kLevels + 0.5);
}

uint key_of(uint level, int layer, ivec2 way) {
    return level << 20u | uint(layer) << 18u | uint(way.y + 256) << 9u | uint(way.x + 256);
}

uint level_in(uint key) { return key >> 20u & 2047u; }
ivec2 way_in(uint key) { return ivec2(key & 511u, key >> 9u & 511u) - 256; }
int layer_in(uint key) { return int(key >> 18u & 3u); }
