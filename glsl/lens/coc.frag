#version 450 core
#include <pass>
#include "lens.glsl"

void main() { out_coc = coc_at(ivec2(gl_FragCoord.xy), lens_at_infinity_px()); }
