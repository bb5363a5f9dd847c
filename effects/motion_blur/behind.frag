#version 450 core
#include <pass>
#include "motion.glsl"
#include "layer_motion.glsl"

#ifdef HAS_OUT_THIRD_MOTION
Motion third_motion(ivec2 p) {
    LayerPixel pixel = LayerPixel(1.0, 0.0);
#ifdef HAS_THIRD_OBJECT_ID
    pixel.scale = objects(texelFetch(third_object_id, p, 0).r).scale;
#endif
#ifdef HAS_THIRD_DEPTH
    pixel.depth_m = texelFetch(third_depth, p, 0).r;
#endif
#if defined(HAS_THIRD_VELOCITY_NEXT) && CURVE
    return layer_motion(third, third_velocity, third_velocity_next, pixel, p);
#else
    return layer_motion(third, third_velocity, third_velocity, pixel, p);
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
