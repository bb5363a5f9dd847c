#version 450 core
#include <pass>
#include "camera_ray.glsl"

// Below this the picture stands still: over static_frames it drifts by a fraction of a pixel, and rounding does not count as
// motion.
const float kStillPx = 1.0 / 256.0;
const float kOutside = 1.0, kOtherDepth = 2.0, kOtherObject = 3.0;

// What the 3 x 3 px show. Jitter moves an edge by less than a pixel, so what was at this place in the frame before is among it.
struct Surroundings {
    ivec2 closest;
    float near_m, far_m;
    uint least_id, greatest_id;
};

Surroundings surroundings(ivec2 p) {
    ivec2 last = ivec2(depth_size.xy) - 1;
    Surroundings found = Surroundings(p, texelFetch(depth, p, 0).r, 0.0, 0xffffffffu, 0u);
    found.far_m = found.near_m;
    for (int i = 0; i < 9; ++i) {
        ivec2 at = clamp(p + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        float depth_m = texelFetch(depth, at, 0).r;
        if (depth_m < found.near_m) found.closest = at;
        found.near_m = min(found.near_m, depth_m);
        found.far_m = max(found.far_m, depth_m);
#if defined(HAS_OBJECT_ID) && DISOCCLUSION == DISOCCLUSION_DEPTH_AND_ID
        uint id = texelFetch(object_id, at, 0).r;
        found.least_id = min(found.least_id, id);
        found.greatest_id = max(found.greatest_id, id);
#endif
    }
    return found;
}

vec2 motion_px(Ray ray, Surroundings around) {
#ifdef HAS_VELOCITY
    vec2 motion = texelFetch(velocity, around.closest, 0).xy;
#else
    vec2 motion = camera_motion_px(ray, gl_FragCoord.xy, around.near_m);
#endif
    return max(abs(motion.x), abs(motion.y)) < kStillPx ? vec2(0.0) : motion;
}

// Why the history at `q` shows something else; 0 where it does not.
float other_surface(Ray ray, Surroundings around, ivec2 q) {
#if DISOCCLUSION != DISOCCLUSION_NONE
    float depth_m = texelFetch(depth_prev, q, 0).r;
    float near_m = previous_depth_m(ray, around.near_m) * (1.0 - param.depth_tolerance);
    float far_m = previous_depth_m(ray, around.far_m) * (1.0 + param.depth_tolerance);
    if (!(depth_m >= near_m && depth_m <= far_m)) return kOtherDepth;
#if defined(HAS_OBJECT_ID) && DISOCCLUSION == DISOCCLUSION_DEPTH_AND_ID
    uint id = texelFetch(object_id_prev, q, 0).r;
    if (id < around.least_id || id > around.greatest_id) return kOtherObject;
#endif
#endif
    return 0.0;
}

// Frames of history that may count, so that it counts n / (n + 1).
float most_frames(vec2 motion) {
    float moving = param.history_weight / (1.0 - param.history_weight);
    return motion == vec2(0.0) ? max(float(param.static_frames) - 1.0, moving) : moving;
}

void main() {
    Surroundings around = surroundings(ivec2(gl_FragCoord.xy));
    Ray ray = camera_ray(ndc_of(gl_FragCoord.xy));
    vec2 motion = motion_px(ray, around);
    vec2 before = gl_FragCoord.xy - motion;
    // A motion that is no number is in no picture, either.
    bool inside = all(greaterThanEqual(before, vec2(0.0))) && all(lessThan(before, depth_size.xy));
    if (!inside) motion = vec2(0.0);
    ivec2 q = inside ? ivec2(before) : ivec2(gl_FragCoord.xy);
    float fault = inside ? other_surface(ray, around, q) : kOutside;
    bool usable = frame.history_valid && fault == 0.0;
    float frames = usable ? min(texelFetch(age_prev, q, 0).r, most_frames(motion)) : 0.0;
    out_motion = vec4(motion, frames, frame.history_valid ? fault : 0.0);
}
