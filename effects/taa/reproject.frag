#version 450 core
#include <pass>
#include "camera_ray.glsl"

// Below this the picture stands still: over static_frames it drifts by a fraction of a pixel, and rounding does not count as
// motion.
const float kStillPx = 1.0 / 256.0;
// For a motion that is no number: outside every picture.
const float kNowherePx = 1e9;
// Motions that differ by less are one motion.
const float kOtherMotionPx = 0.5;
// What became of history.
const float kTaken = 1.0, kOutside = 2.0, kOtherDepth = 3.0, kOtherObject = 4.0, kOtherMotion = 5.0;

// What the 3 x 3 px show. Jitter moves an edge by less than a pixel, so what was at this place in the frame before is among it.
struct Surroundings {
    ivec2 closest;
    float near_m, far_m;
    uint least_id, greatest_id;
};

Surroundings surroundings(ivec2 p) {
    Surroundings found = Surroundings(p, texelFetch(depth, p, 0).r, 0.0, 0xffffffffu, 0u);
    found.far_m = found.near_m;
    ivec2 last = ivec2(depth_size.xy) - 1;
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

vec2 motion_px(Ray ray, ivec2 p, float depth_m) {
#ifdef HAS_VELOCITY
    vec2 motion = texelFetch(velocity, p, 0).xy;
#else
    vec2 motion = camera_motion_px(ray, gl_FragCoord.xy, depth_m);
#endif
    if (any(isnan(motion)) || any(isinf(motion))) return vec2(kNowherePx);
    return max(abs(motion.x), abs(motion.y)) < kStillPx ? vec2(0.0) : motion;
}

// Whether the history at `q` shows something else, and how that is seen.
float surface_verdict(Ray ray, Surroundings around, ivec2 q) {
#if DISOCCLUSION != DISOCCLUSION_NONE
    float depth_m = texelFetch(depth_prev, q, 0).r;
    float near_m = previous_depth_m(ray, around.near_m) * (1.0 - param.depth_tolerance);
    float far_m = previous_depth_m(ray, around.far_m) * (1.0 + param.depth_tolerance);
    if (depth_m < near_m || depth_m > far_m) return kOtherDepth;
#if defined(HAS_OBJECT_ID) && DISOCCLUSION == DISOCCLUSION_DEPTH_AND_ID
    uint id = texelFetch(object_id_prev, q, 0).r;
    if (id < around.least_id || id > around.greatest_id) return kOtherObject;
#endif
#endif
    return kTaken;
}

// Beside an edge history follows the object in front. Where that has gone on, what it brought along does not belong.
float motion_verdict(vec2 motion, ivec2 q) {
    vec4 before = texelFetch(motion_prev, q, 0);
    bool borrowed = before.w < 0.0;
    return borrowed && distance(motion, before.xy) > kOtherMotionPx ? kOtherMotion : kTaken;
}

// Frames of history that may count, so that it counts n / (n + 1).
float most_frames(vec2 motion) {
    float moving = param.history_weight / (1.0 - param.history_weight);
    return motion == vec2(0.0) ? max(float(param.static_frames) - 1.0, moving) : moving;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Surroundings around = surroundings(p);
    Ray ray = camera_ray(ndc_of(gl_FragCoord.xy));
    vec2 motion = motion_px(ray, around.closest, around.near_m);
    vec2 own_motion = motion_px(ray, p, texelFetch(depth, p, 0).r);
    vec2 before = gl_FragCoord.xy - motion;
    bool inside = all(greaterThanEqual(before, vec2(0.0))) && all(lessThan(before, depth_size.xy));
    bool borrowed = distance(motion, own_motion) > kOtherMotionPx;
    if (!inside) motion = vec2(0.0);
    ivec2 q = inside ? ivec2(before) : p;
    float verdict = inside ? surface_verdict(ray, around, q) : kOutside;
    if (verdict == kTaken) verdict = motion_verdict(motion, q);
    bool usable = frame.history_valid && verdict == kTaken;
    float frames = usable ? min(texelFetch(age_prev, q, 0).r, most_frames(motion)) : 0.0;
    out_motion = vec4(motion, frames, borrowed ? -verdict : verdict);
}
