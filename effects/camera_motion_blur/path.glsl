#include <camera_rays.glsl>
#include <shutter/shutter.glsl>

// Between the frame before (t = -1) and this one (t = 0) the camera turns about one axis and goes straight on, both at constant
// speed, and so it does after this frame.
struct Motion {
    vec3 axis;      // of length 1, in this frame's view
    float angle;    // rad, from this frame's view to the one before
    vec3 before_m;  // where the camera was
};

Motion camera_motion() {
    mat3 turn = mat3(camera.prev_view_from_view);
    vec3 twice_sine = vec3(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
    float sine = 0.5 * length(twice_sine);
    float cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0);
    vec3 axis = sine > 0.0 ? 0.5 * twice_sine / sine : vec3(0.0, 0.0, 1.0);
    return Motion(axis, atan(sine, cosine), -transpose(turn) * camera.prev_view_from_view[3].xyz);
}

bool camera_moves() {
    // Both are rounded from the same doubles.
    return camera.has_matrices && camera.has_prev_matrices && camera.prev_clip_from_view != camera.clip_from_view;
}

// A pixel's lines of sight, with z = -1, through this frame's lens and through that of the frame before, which differ by a zoom.
struct Sight {
    vec2 px;
    vec3 now;
    vec3 before;
};

Sight sight_of(vec2 px) {
    vec2 ndc = ndc_of_pixel(px + camera.jitter_px);
    vec3 before = mat3(camera.prev_view_from_view) * view_point(camera.prev_clip_from_view, ndc, 0.0).xyz;
    return Sight(px, view_point(camera.clip_from_view, ndc, 0.0).xyz, before / -before.z);
}

// Where this frame's picture shows what the camera has in front of the pixel at time t, if that lies on the plane of depth
// 1 / per_m, px from the pixel: Rodrigues' formula turns the line of sight back to this frame's view. At most share_px of it.
vec2 offset_at(Motion motion, Sight sight, float t, float per_m, float share_px) {
    vec3 line = mix(sight.now, sight.before, -t);
    float angle = t * motion.angle;
    float cosine = cos(angle);
    vec3 way = line * cosine + cross(motion.axis, line) * sin(angle) + motion.axis * (dot(motion.axis, line) * (1.0 - cosine));
    vec3 camera_at = -t * per_m * motion.before_m;  // times 1 / depth, as the point below
    float along = (1.0 + camera_at.z) / -way.z;
    vec4 clip = camera.clip_from_view * vec4(camera_at + along * way, per_m);
    // Behind the camera, now or then, nothing is seen: no motion.
    if (!(way.z < 0.0 && along > 0.0 && clip.w > 0.0)) return vec2(0.0);
    vec2 offset = pixel_of_clip(clip) - camera.jitter_px - sight.px;
    return offset * min(1.0, share_px / max(length(offset), 1e-6));
}

// What the length of a whole path leaves to the way from this frame to time t.
float share_px(vec2 span, float t) { return param.max_blur * abs(t) / (span.y - span.x); }
