// Lines of sight of a camera, in its view space, and where its picture shows a point. Needs the blocks frame and camera.

// NDC of a place in px of the working grid, where (0.5, 0.5) is the middle of the top left pixel.
vec2 ndc_of_pixel(vec2 pixel) {
    vec2 at = (pixel + vec2(frame.origin)) / vec2(frame.display_size);
    return vec2(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y);
}

// The other way round; for points in front of the camera, that is clip.w > 0.
vec2 pixel_of_clip(vec4 clip) {
    vec2 at = 0.5 + 0.5 * vec2(clip.x, -clip.y) / clip.w;
    return at * vec2(frame.display_size) - vec2(frame.origin);
}

// 1 / depth, 1/m: 0 for what is infinitely far away, so that nothing after it meets an infinity.
float inverse_depth(float depth_m) { return isinf(depth_m) ? 0.0 : 1.0 / depth_m; }

// The homogeneous point that ndc shows at a depth: z = -1, w = 1 / depth; at 0 a direction. A row r of the projection gives
// ndc * (r_w . p) = r . p, which for x and y are two equations.
vec4 view_point(mat4 clip_from_view, vec2 ndc, float per_m) {
    mat4 rows = transpose(clip_from_view);
    vec4 a = rows[0] - ndc.x * rows[3], b = rows[1] - ndc.y * rows[3];
    float right_a = a.z - a.w * per_m, right_b = b.z - b.w * per_m;
    float determinant = a.x * b.y - a.y * b.x;
    return vec4(right_a * b.y - a.y * right_b, a.x * right_b - right_a * b.x, -determinant, determinant * per_m) / determinant;
}
