#version 450 core
#include <pass>
#include "motion.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec2 since = finite(texelFetch(velocity, p, 0).xy);
    vec2 next = since;
#if defined(HAS_VELOCITY_NEXT) && CURVE
    next = finite(texelFetch(velocity_next, p, 0).xy);
#endif
    float scale = 1.0;
#ifdef HAS_OBJECT_ID
    scale = objects(texelFetch(object_id, p, 0).r).scale;
#endif
    out_motion = pack_motion(motion_of(since, next, scale, texelFetch(depth, p, 0).r));
}
