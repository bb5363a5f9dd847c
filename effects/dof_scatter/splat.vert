#version 450 core
#include <pass>
#include <behind.glsl>
#include <lens/lens.glsl>
#include "slices.glsl"

flat out vec4 light;
flat out vec3 middle_radius;  // px, signed

struct Texel {
    vec4 light;  // of alpha 0 where the layer is empty
    float depth_m;
};

Texel texel_of(int layer, ivec2 p) {
#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
    if (layer == 1) return Texel(texelFetch(second, p, 0), texelFetch(second_depth, p, 0).r);
#endif
#if defined(HAS_THIRD) && defined(HAS_THIRD_DEPTH)
    if (layer == 2) return Texel(texelFetch(third, p, 0), texelFetch(third_depth, p, 0).r);
#endif
#if defined(HAS_FOURTH) && defined(HAS_FOURTH_DEPTH)
    if (layer == 3) return Texel(texelFetch(fourth, p, 0), texelFetch(fourth_depth, p, 0).r);
#endif
    return Texel(vec4(0.0), 0.0);
}

// Pixels beyond the edges are the nearest ones of the picture.
void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: no fragments
    light = vec4(0.0);
    middle_radius = vec3(0.0);
    vec2 largest_px = texelFetch(range, ivec2(0), 0).rg;
    ivec2 size = ivec2(color_size.xy);
    int margin = margin_px(largest_px), across = size.x + 2 * margin;
    int in_layer = across * (size.y + 2 * margin), layer = gl_InstanceID / in_layer, i = gl_InstanceID % in_layer;
    ivec2 at = ivec2(i % across, i / across) - margin;
    ivec2 texel = clamp(at, ivec2(0), size - 1);
    float radius = texelFetch(coc, texel, 0).r;
    vec4 color_here = texelFetch(color, texel, 0);
    if (layer > 0) {
        Texel behind = texel_of(layer, texel);
        color_here = covering(behind.light);
        if (color_here.a == 0.0) return;
        float at_infinity_px = lens_at_infinity_px(), front = radius;
        radius = coc_of(behind.depth_m, at_infinity_px);
        int slice = slice_of(largest_px, radius);
        for (int k = 0; k < layer; ++k) {
            if (k > 0) front = coc_of(texel_of(k, texel).depth_m, at_infinity_px);
            if (slice_of(largest_px, front) == slice) return;  // stays hidden: within a slice, light is averaged
        }
    }
    if (slice_of(largest_px, radius) != pass.index) return;

    vec2 middle = vec2(at) + 0.5;
    float reach = abs(radius) < kSharp ? 0.5 : abs(radius) + 0.5;
    vec2 low = floor(middle - reach), high = ceil(middle + reach);
    if (reach == 0.5) {
        low = vec2(at);
        high = vec2(at + 1);
    }
    if (any(lessThanEqual(high, vec2(0.0))) || any(greaterThanEqual(low, vec2(size)))) return;
    light = color_here;
    middle_radius = vec3(middle, abs(radius) < kSharp ? 0.0 : radius);
    vec2 corner = mix(low, high, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    gl_Position = vec4(2.0 * corner.x * color_size.z - 1.0, 1.0 - 2.0 * corner.y * color_size.w, 0.0, 1.0);
}
