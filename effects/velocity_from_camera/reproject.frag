#version 450 core
#include <pass>
#include <camera_rays.glsl>

// The longest side that a picture can have; a point that passed close by the lens has moved by any number of px.
const float kLongest_px = 16384.0;
// Depth before over depth now, below which the point counts as behind the camera.
const float kBehind = 1e-6;

void main() {
    bool known = camera.has_matrices && camera.has_prev_matrices;
    // Both are rounded from the same doubles: a camera at rest gives no motion at all, rather than rounding's.
    bool at_rest = camera.prev_clip_from_view == camera.clip_from_view;
    vec2 here = gl_FragCoord.xy + camera.jitter_px;
    float per_m = inverse_depth(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r);
    vec4 before = camera.prev_clip_from_view * view_point(camera.clip_from_view, ndc_of_pixel(here), per_m);
    vec2 velocity = vec2(0.0);
    if (known && !at_rest && before.w > kBehind) velocity = here - pixel_of_clip(before);
    out_velocity = velocity * min(1.0, kLongest_px / max(length(velocity), 1.0));
}
