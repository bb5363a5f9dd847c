#version 450 core
#include <pass>
#include "taps.glsl"
#include "cones.glsl"
#if METHOD == METHOD_BOWLES_2012
#include "bowles_2012.glsl"
#elif METHOD == METHOD_JIMENEZ_2014
#include "jimenez_2014.glsl"
#elif METHOD == METHOD_GUERTIN_2014
#include "guertin_2014.glsl"
#else
#include "mcguire_2012.glsl"
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 point = vec2(p) + 0.5;
    out_color = through_shutter(p, point, motion_at(point), texelFetch(around_path, p / kTile, 0));
}
