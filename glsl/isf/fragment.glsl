#include <isf/images.glsl>
#include <coverage.glsl>

vec4 isf_data[1] = vec4[](vec4(0.0));
vec4 isf_coord() { return vec4(gl_FragCoord.x, ISF_SIZE.y - gl_FragCoord.y, gl_FragCoord.zw); }
vec2 isf_norm_coord() { return isf_coord().xy / ISF_SIZE; }

vec4 isf_sample_here(sampler2D image) {
#ifdef ISF_ALIKE
    // All images have the target's size, so that the pixel lies on a texel and needs no filter.
    return texelFetch(image, ivec2(gl_FragCoord.xy), 0);
#else
    return isf_sample(image, isf_norm_coord());
#endif
}

// A target of 8 bits cuts by itself; the picture holds floats.
vec4 isf_target(vec4 color) { return color; }
vec4 isf_display(vec4 color) {
    // By the bits, which takes llvmpipe fewer operations than isnan().
    ivec4 size = floatBitsToInt(color) & 0x7FFFFFFF;
    return mix(clamp(color, 0.0, 1.0), vec4(0.0), greaterThan(size, ivec4(0x7F800000)));
}
vec4 isf_linear(vec4 color) {
    vec4 light = mix(color, vec4(0.0), isnan(color));
    float alpha = clamp(light.a, 0.0, 1.0);
    return vec4(has_coverage(alpha) ? light.rgb * alpha : light.rgb, alpha);
}
