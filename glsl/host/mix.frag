#version 450 core
// A step's "mix" and "mask": the image before the step and the image that it made, by amount * mask. The host
// defines MASK_IMAGE, MASK_FILE or MASK_OBJECTS; and NOTHING_IS_0 or
// NOTHING_IS_1 where no step has made the image before, and no capture can; WHOLE_OR_NOTHING for values that have no mean.
#if !defined(NOTHING_IS_0) && !defined(NOTHING_IS_1)
layout(binding = 0) uniform sampler2D before;
#endif
layout(binding = 1) uniform sampler2D after;

layout(std140, binding = 0) uniform MixBlock {
    float amount;
    int invert;
    int object_count;
    int unused;
    ivec2 origin;        // display-window pixel of texel (0, 0)
    ivec2 display_size;  // px
    uvec4 objects[1000];  // first and last id of a range; they rise, with a gap between any two
} mixing;

layout(location = 0) out vec4 result;

#if defined(MASK_IMAGE)
layout(binding = 2) uniform sampler2D mask_image;
float mask(ivec2 pixel) { return texelFetch(mask_image, pixel, 0).r; }
#elif defined(MASK_FILE)
layout(binding = 2) uniform sampler2D mask_image;
float mask(ivec2 pixel) {
    return textureLod(mask_image, (vec2(pixel + mixing.origin) + 0.5) / vec2(mixing.display_size), 0.0).r;
}
#elif defined(MASK_OBJECTS)
layout(binding = 2) uniform usampler2D object_id;
float mask(ivec2 pixel) {
    uint id = texelFetch(object_id, pixel, 0).r;
    int low = 0, high = mixing.object_count;
    while (low < high) {  // to the first range that ends at the id or above it
        int middle = (low + high) / 2;
        if (mixing.objects[middle].y < id) low = middle + 1;
        else high = middle;
    }
    return low < mixing.object_count && mixing.objects[low].x <= id ? 1.0 : 0.0;
}
#else
float mask(ivec2 pixel) { return 1.0; }
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float weight = clamp(mask(pixel), 0.0, 1.0);
    if (mixing.invert != 0) weight = 1.0 - weight;
    weight *= mixing.amount;
#if defined(NOTHING_IS_0)
    vec4 a = vec4(0.0);
#elif defined(NOTHING_IS_1)
    vec4 a = vec4(vec3(1.0), 0.0);
#else
    vec4 a = texelFetch(before, pixel, 0);
#endif
    vec4 b = texelFetch(after, pixel, 0);
#ifdef WHOLE_OR_NOTHING
    result = weight >= 1.0 ? b : a;  // places do not mix
#else
    // The ends are exact, and infinite depth stays what it is: inf - inf would be NaN.
    result = weight <= 0.0 ? a : weight >= 1.0 ? b : mix(a, b, weight);
#endif
}
