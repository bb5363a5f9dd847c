#version 450 core
#include <pass>
#include "highlight.glsl"
#include "lens.glsl"

vec2 texel_of_blocks() { return coc_size.zw; }
vec4 block(ivec2 p, vec2 texel) { return textureGather(coc, vec2(p + 1) * texel); }

#include "step.glsl"

void main() { out_coc_step = step_of(ivec2(gl_FragCoord.xy)); }
