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

// What the camera has in front of a pixel at a time of the exposure: a line in this frame's view.
struct Moment {
    vec3 way;
    vec3 from_m;
    float most_px;  // of its way to this frame, out of max_blur for the whole path
};

// Rodrigues' formula turns the line of sight back to this frame's view.
Moment moment_at(Motion motion, Sight sight, vec2 span, float t) {
    vec3 line = mix(sight.now, sight.before, -t);
    float cosine = cos(t * motion.angle), sine = sin(t * motion.angle);
    vec3 way = line * cosine + cross(motion.axis, line) * sine + motion.axis * (dot(motion.axis, line) * (1.0 - cosine));
    return Moment(way, -t * motion.before_m, param.max_blur * abs(t) / (span.y - span.x));
}

// Where this frame's picture shows what the line meets on the plane of depth 1 / per_m, px from the pixel.
vec2 offset_at(Moment moment, Sight sight, float per_m) {
    vec3 from = moment.from_m * per_m;  // times 1 / depth, as the point below
    float along = (1.0 + from.z) / -moment.way.z;
    vec4 clip = camera.clip_from_view * vec4(from + along * moment.way, per_m);
    // Behind the camera, now or then, nothing is seen: no motion.
    if (!(moment.way.z < 0.0 && along > 0.0 && clip.w > 0.0)) return vec2(0.0);
    vec2 offset = pixel_of_clip(clip) - camera.jitter_px - sight.px;
    return offset * min(1.0, moment.most_px / max(length(offset), 1e-6));
}
