#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include "coarse.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), half_size = frame.size >> 1;
    int level = p.x < half_size.x ? 1 : p.y < half_size.y >> 1 ? 2 : 3;
    Grid grid = grid_of(level);
    out_coarse = texelFetch(light, min(p - grid.origin, grid.last), level);
    out_coarse_coc = unpack_light(out_coarse).coc;
}
