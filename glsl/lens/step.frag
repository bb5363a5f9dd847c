#version 450 core
#include <pass>
#include "highlight.glsl"
#include "lens.glsl"

vec4 block(ivec2 p) { return textureGather(coc, vec2(p + 1) * coc_size.zw); }

#include "step.glsl"

void main() { out_coc_step = step_of(ivec2(gl_FragCoord.xy)); }
