#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include "coarse.glsl"

void main() {
    Grid grid = grid_of(LEVEL);
    out_coarse = texelFetch(light, min(ivec2(gl_FragCoord.xy) - grid.origin, grid.last), LEVEL);
    out_coarse_coc = unpack_light(out_coarse).coc;
}
