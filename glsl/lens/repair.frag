#version 450 core
#include <pass>
#include "highlight.glsl"
#include "lens.glsl"
#include "repair.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_coc = repaired_coc(p, lens_at_infinity_px(), texelFetch(coc_step, p / kRepairTile, 0).g);
}
