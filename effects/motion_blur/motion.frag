#version 450 core
#include <pass>
#include "motion_here.glsl"

void main() {
    Motion m = motion_here(ivec2(gl_FragCoord.xy));
    out_motion = pack_path(m.path);
#ifdef SHARES_PIXELS
    out_motion_share = vec2(m.depth_m, m.share);
#endif
}
