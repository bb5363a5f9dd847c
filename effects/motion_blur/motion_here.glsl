#include "motion.glsl"

#ifdef HAS_OBJECT_ID
// The factor of an object's motion. Software GL loads from the table lane by lane, which took longer than all else here. So the pass rest
// has loaded that of the objects without a row, objects_default. In a table without rows the load is compared with itself, and left out.
float scale_of(uint id) {
    float scale = objects(id).scale;
    bool has_row = floatBitsToUint(scale) != floatBitsToUint(objects_default.scale);
    return has_row ? scale : texelFetch(tile_scale, ivec2(0), 0).r;
}
#endif

// Motion of a pixel of the picture by the capture.
Motion flat_motion(ivec2 p) {
    vec2 since = finite(texelFetch(velocity, p, 0).xy), next = since;
#if defined(HAS_VELOCITY_NEXT) && CURVE
    next = finite(texelFetch(velocity_next, p, 0).xy);
#endif
    float scale = 1.0;
#ifdef HAS_OBJECT_ID
    scale = scale_of(texelFetch(object_id, p, 0).r);
#endif
    return motion_of(since, next, scale, texelFetch(depth, p, 0).r);
}

#ifdef SHARES_PIXELS
#include "layer_motion.glsl"

Motion first_motion(ivec2 p) {
    LayerPixel pixel = LayerPixel(1.0, texelFetch(first_depth, p, 0).r);
#ifdef HAS_FIRST_OBJECT_ID
    pixel.scale = objects(texelFetch(first_object_id, p, 0).r).scale;
#endif
#if defined(HAS_FIRST_VELOCITY_NEXT) && CURVE
    return layer_motion(first, first_velocity, first_velocity_next, pixel, p);
#else
    return layer_motion(first, first_velocity, first_velocity, pixel, p);
#endif
}

const float kWholePixel = 0.999;

// Where several surfaces share the pixel, that of the nearest one. Surfaces that move alike are one.
Motion motion_here(ivec2 p) {
    Motion whole = flat_motion(p), front = first_motion(p), behind = second_motion(p);
    bool is_shared = front.share > 0.0 && front.share < kWholePixel && behind.share > 0.0;
    return is_shared && !is_alike(front.path, behind.path) ? front : whole;
}
#else
Motion motion_here(ivec2 p) { return flat_motion(p); }
#endif
