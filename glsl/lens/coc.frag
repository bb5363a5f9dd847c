#version 450 core
#include <pass>
#include "lens.glsl"

layout(location = 0) flat in float at_infinity_px;

void main() { out_coc = coc_at(ivec2(gl_FragCoord.xy), at_infinity_px); }
