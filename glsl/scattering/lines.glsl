// Where pixels lie on the surface, in view space, mm of the scattering profile. x goes right, y up, the camera looks
// along -z; a pixel's middle is at + 0.5.

// At depth z (m) pixel p shows world_unit * z * vec3(p * slope + offset, -1).
struct ViewLines {
    vec2 slope;   // per px; y falls as rows go down
    vec2 offset;
};

ViewLines view_lines() {
    vec2 display = vec2(frame.display_size);
    // Middle of the picture at 0, pixels square: pixels per millimetre on the sensor are those of the display window's width.
    vec2 half_extent = vec2(0.5 * display.x, -0.5 * display.y) * param.sensor_width / (param.focal_length * display.x);
    vec2 shift = vec2(0.0);
    if (camera.has_matrices) {
        // ndc = (P_xx x + P_xz z) / -z, and so on for y.
        vec2 scale = vec2(camera.clip_from_view[0][0], camera.clip_from_view[1][1]);
        shift = vec2(camera.clip_from_view[2][0], camera.clip_from_view[2][1]) / scale;
        half_extent = vec2(1.0, -1.0) / scale;
    }
    vec2 slope = 2.0 * half_extent / display;
    return ViewLines(slope, slope * vec2(frame.origin) - half_extent + shift);
}

// Direction to a place in px, its z -1.
vec3 view_line(ViewLines lines, vec2 pixel) { return vec3(pixel * lines.slope + lines.offset, -1.0); }

// Point of the surface, mm.
vec3 view_position(ViewLines lines, vec2 pixel, float depth_m) {
    return param.world_unit * depth_m * view_line(lines, pixel);
}

// Pixels across which 1 mm goes that faces the camera.
float pixels_per_mm(ViewLines lines, float depth_m) { return 1.0 / (param.world_unit * depth_m * lines.slope.x); }
