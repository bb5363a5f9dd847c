#version 450 core
#include <pass>
#include <lens/highlight.glsl>
#include <lens/lens.glsl>
#include <lens/repair.glsl>
#include "tile.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_lit_coc = repaired_coc(p, lens_at_infinity_px(), texelFetch(tile_step, p / kTile, 0).g);
}
