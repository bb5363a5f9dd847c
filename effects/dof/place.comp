#version 450 core
#include <pass>

layout(local_size_x = 256) in;

shared uint sums[256];

// Sums of all tiles before each: every invocation takes a run of tiles. The order is always the same, so the bits are too.
void main() {
    uint own = gl_LocalInvocationIndex, count = uint(tile_count.length()), run = (count + 255u) / 256u;
    uint begin = min(own * run, count), end = min(begin + run, count), sum = 0u;
    for (uint i = begin; i < end; ++i) sum += tile_count[i];
    sums[own] = sum;
    barrier();
    uint before = 0u;
    for (uint i = 0u; i < own; ++i) before += sums[i];
    for (uint i = begin; i < end; ++i) {
        tile_first[i] = before;
        before += tile_count[i];
    }
    if (own == 255u) highlight_args[1] = before;
}
