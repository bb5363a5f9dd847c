#include "key.glsl"

bool is_traced(ivec2 tile, int band) {
#ifdef HAS_MEET
    if (texelFetch(meet, tile, 0).r == 0.0) return false;
#endif
    return param.samples > (band - 1) * kBandSamples;
}

bool traced_tiles_1(ivec2 tile) { return is_traced(tile, 1); }
bool traced_tiles_2(ivec2 tile) { return is_traced(tile, 2); }
bool traced_tiles_3(ivec2 tile) { return is_traced(tile, 3); }
bool traced_tiles_4(ivec2 tile) { return is_traced(tile, 4); }
