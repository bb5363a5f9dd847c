#version 450 core
#include <pass>
#include <lens/lens.glsl>
#include "slices.glsl"

flat out vec4 light;
flat out float cover;
flat out vec3 middle_radius;  // px, signed

struct Texel {
    vec4 light;   // premultiplied
    float cover;  // share of the pixel; 0 where the layer is empty
    float coc;    // px
};

Texel layer_of(vec4 light, float depth_m, float at_infinity_px) { return Texel(light, light.a, coc_of(depth_m, at_infinity_px)); }

// The picture's own pixel, unless several layers share it.
Texel texel_of(int layer, ivec2 p, float at_infinity_px) {
#if defined(HAS_SECOND) && defined(HAS_SECOND_DEPTH)
    if (layer == 1) return layer_of(texelFetch(second, p, 0), texelFetch(second_depth, p, 0).r, at_infinity_px);
#endif
#if defined(HAS_THIRD) && defined(HAS_THIRD_DEPTH)
    if (layer == 2) return layer_of(texelFetch(third, p, 0), texelFetch(third_depth, p, 0).r, at_infinity_px);
#endif
#if defined(HAS_FOURTH) && defined(HAS_FOURTH_DEPTH)
    if (layer == 3) return layer_of(texelFetch(fourth, p, 0), texelFetch(fourth_depth, p, 0).r, at_infinity_px);
#endif
#ifdef SHARES_PIXELS
    vec4 front = texelFetch(first, p, 0);
    if (front.a > 0.0 && front.a < kWholePixel) return layer_of(front, texelFetch(first_depth, p, 0).r, at_infinity_px);
#endif
    return Texel(texelFetch(color, p, 0), 1.0, texelFetch(coc, p, 0).r);
}

// Within a slice, light is averaged: there the layers in front hide the one behind in the pixel itself.
float seen_past(int layer, int slice, vec2 largest_px, ivec2 p, float at_infinity_px) {
    float seen = 1.0;
    for (int k = 0; k < layer; ++k) {
        Texel front = texel_of(k, p, at_infinity_px);
        if (slice_of(largest_px, front.coc) == slice) seen *= 1.0 - front.cover;
    }
    return seen;
}

// Pixels beyond the edges are the nearest ones of the picture.
void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: no fragments
    light = vec4(0.0);
    cover = 0.0;
    middle_radius = vec3(0.0);
    vec2 largest_px = texelFetch(range, ivec2(0), 0).rg;
    ivec2 size = ivec2(color_size.xy);
    int margin = margin_px(largest_px), across = size.x + 2 * margin;
    int in_layer = across * (size.y + 2 * margin), layer = gl_InstanceID / in_layer, i = gl_InstanceID % in_layer;
    ivec2 at = ivec2(i % across, i / across) - margin;
    ivec2 texel = clamp(at, ivec2(0), size - 1);
    float at_infinity_px = lens_at_infinity_px();
    Texel own = texel_of(layer, texel, at_infinity_px);
    float radius = own.coc;
    if (own.cover <= 0.0 || slice_of(largest_px, radius) != pass.index) return;
    float seen = seen_past(layer, pass.index, largest_px, texel, at_infinity_px);
    if (seen * own.cover <= 0.0) return;

    vec2 middle = vec2(at) + 0.5;
    float reach = abs(radius) < kSharp ? 0.5 : abs(radius) + 0.5;
    vec2 low = floor(middle - reach), high = ceil(middle + reach);
    if (reach == 0.5) {
        low = vec2(at);
        high = vec2(at + 1);
    }
    if (any(lessThanEqual(high, vec2(0.0))) || any(greaterThanEqual(low, vec2(size)))) return;
    light = seen * own.light;
    cover = seen * own.cover;
    middle_radius = vec3(middle, abs(radius) < kSharp ? 0.0 : radius);
    vec2 corner = mix(low, high, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    gl_Position = vec4(2.0 * corner.x * color_size.z - 1.0, 1.0 - 2.0 * corner.y * color_size.w, 0.0, 1.0);
}
