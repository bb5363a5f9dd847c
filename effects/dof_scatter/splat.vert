#version 450 core
#include <pass>
#include "slices.glsl"

flat out vec4 light;
flat out vec3 middle_radius;  // px, signed

// Pixels beyond the edges are the nearest ones of the picture.
void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: no fragments
    light = vec4(0.0);
    middle_radius = vec3(0.0);
    vec2 largest_px = texelFetch(range, ivec2(0), 0).rg;
    ivec2 size = ivec2(color_size.xy);
    int margin = margin_px(largest_px), across = size.x + 2 * margin;
    ivec2 at = ivec2(gl_InstanceID % across, gl_InstanceID / across) - margin;
    ivec2 texel = clamp(at, ivec2(0), size - 1);
    float radius = texelFetch(coc, texel, 0).r;
    if (slice_of(largest_px, radius) != pass.index) return;

    vec2 middle = vec2(at) + 0.5;
    float reach = abs(radius) < kSharp ? 0.5 : abs(radius) + 0.5;
    vec2 low = floor(middle - reach), high = ceil(middle + reach);
    if (reach == 0.5) {
        low = vec2(at);
        high = vec2(at + 1);
    }
    if (any(lessThanEqual(high, vec2(0.0))) || any(greaterThanEqual(low, vec2(size)))) return;
    light = texelFetch(color, texel, 0);
    middle_radius = vec3(middle, abs(radius) < kSharp ? 0.0 : radius);
    vec2 corner = mix(low, high, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    gl_Position = vec4(2.0 * corner.x * color_size.z - 1.0, 1.0 - 2.0 * corner.y * color_size.w, 0.0, 1.0);
}
