// Points of view space that a pixel sees, by their depth: at(d) = origin + d * direction, with d along the view axis.
struct Ray {
    vec3 origin;     // 0 for a perspective camera
    vec3 direction;  // z is -1
};

// Row i of the projection, r_i, gives ndc_i (r_3 . p) = r_i . p: two equations in p.x and p.y, whose right side is linear in
// depth.
Ray camera_ray(vec2 ndc) {
    mat4 rows = transpose(camera.clip_from_view);
    vec4 a = rows[0] - ndc.x * rows[3], b = rows[1] - ndc.y * rows[3];
    mat2 inverse_xy = inverse(mat2(a.x, b.x, a.y, b.y));
    Ray ray;
    ray.origin = vec3(inverse_xy * -vec2(a.w, b.w), 0.0);
    ray.direction = vec3(inverse_xy * vec2(a.z, b.z), -1.0);
    return ray;
}

vec2 ndc_of(vec2 px) {
    vec2 at = (px + vec2(frame.origin)) / vec2(frame.display_size);
    return vec2(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y);
}

bool knows_cameras() { return camera.has_matrices && camera.has_prev_matrices; }

// The world's point at that depth; its direction (w = 0) at infinity.
vec4 world_at(Ray ray, float depth_m) {
    bool infinite = isinf(depth_m);
    vec3 point = infinite ? ray.direction : ray.origin + depth_m * ray.direction;
    return camera.world_from_view * vec4(point, infinite ? 0.0 : 1.0);
}

// Current minus previous position of what does not move itself, px.
vec2 camera_motion_px(Ray ray, vec2 px, float depth_m) {
    vec4 clip = camera.prev_clip_from_world * world_at(ray, depth_m);
    if (!knows_cameras() || clip.w <= 0.0) return vec2(0.0);
    vec2 before = vec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * vec2(frame.display_size);
    return px - (before - vec2(frame.origin));
}

// Depth in the frame before of what does not move itself.
float previous_depth_m(Ray ray, float depth_m) {
    if (!knows_cameras() || isinf(depth_m)) return depth_m;
    return -(camera.prev_view_from_world * world_at(ray, depth_m)).z;
}
