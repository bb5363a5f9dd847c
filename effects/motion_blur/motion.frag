#version 450 core
#include <pass>
#include "motion_here.glsl"

void main() { out_motion = pack_motion(motion_here(ivec2(gl_FragCoord.xy))); }
