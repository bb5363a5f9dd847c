// Surfaces between passes, one texel of four words: the texture shape.
#include <scattering/lines.glsl>

struct Shape {
    uint key;  // 0 where nothing scatters, else the same for all pixels that light goes between
    float depth_m;
    vec3 normal;  // world
};

Shape unpacked_shape(uvec4 texel) {
    return Shape(texel.x, uintBitsToFloat(texel.y), vec3(unpackSnorm2x16(texel.z), unpackSnorm2x16(texel.w).x));
}

// Outside the picture nothing scatters.
Shape shape_at(ivec2 pixel) {
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, frame.size))) return Shape(0u, 1.0, vec3(0.0));
    return unpacked_shape(texelFetch(shape, pixel, 0));
}

// View space.
vec3 place_mm(ivec2 pixel, Shape shape) { return view_position(view_lines(), vec2(pixel) + 0.5, shape.depth_m); }

float widest(vec3 d) { return max(d.r, max(d.g, d.b)); }
