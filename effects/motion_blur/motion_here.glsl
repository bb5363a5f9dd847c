#include "motion.glsl"

// Motion of a pixel by the capture, as it is packed.
uvec4 motion_here(ivec2 p) {
    vec2 since = finite(texelFetch(velocity, p, 0).xy);
    vec2 next = since;
#if defined(HAS_VELOCITY_NEXT) && CURVE
    next = finite(texelFetch(velocity_next, p, 0).xy);
#endif
    float scale = 1.0;
#ifdef HAS_OBJECT_ID
    scale = objects(texelFetch(object_id, p, 0).r).scale;
#endif
    return pack_motion(motion_of(since, next, scale, texelFetch(depth, p, 0).r));
}
