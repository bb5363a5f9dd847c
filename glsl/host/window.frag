#version 450 core
// From the display window to the data window and back; 0 where the source has no pixel. INTEGERS for integer formats.
layout(std140, binding = 0) uniform Place {
    int x;  // of the first pixel, in the source
    int y;
} place;

#ifdef INTEGERS
layout(binding = 0) uniform usampler2D source;
layout(location = 0) out uvec4 result;
#else
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 result;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) + ivec2(place.x, place.y), size = textureSize(source, 0);
    bool is_inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
#ifdef INTEGERS
    result = is_inside ? texelFetch(source, pixel, 0) : uvec4(0u);
#else
    result = is_inside ? texelFetch(source, pixel, 0) : vec4(0.0);
#endif
}
