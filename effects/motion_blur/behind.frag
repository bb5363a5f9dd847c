#version 450 core
#include <pass>
#include "motion.glsl"
#include "layer_motion.glsl"

#ifdef HAS_OUT_THIRD_MOTION
Motion third_motion(ivec2 p) {
    float scale = 1.0;
#ifdef HAS_THIRD_OBJECT_ID
    scale = objects(texelFetch(third_object_id, p, 0).r).scale;
#endif
#if defined(HAS_THIRD_VELOCITY_NEXT) && CURVE
    return layer_motion(third, third_velocity, third_velocity_next, third_depth, scale, p);
#else
    return layer_motion(third, third_velocity, third_velocity, third_depth, scale, p);
#endif
}
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_second_motion = pack_motion(second_motion(p));
#ifdef HAS_OUT_THIRD_MOTION
    out_third_motion = pack_motion(third_motion(p));
#endif
}
