#include <isf/images.glsl>
#include <coverage.glsl>

vec4 isf_data[1] = vec4[](vec4(0.0));
vec4 isf_coord() { return vec4(gl_FragCoord.x, ISF_SIZE.y - gl_FragCoord.y, gl_FragCoord.zw); }
vec2 isf_norm_coord() { return isf_coord().xy / ISF_SIZE; }

// In an image of the target's size the pixel lies on a texel, which takes a third of the time of a filtered read.
vec4 isf_sample_here(sampler2D image) {
    bool is_alike = textureSize(image, 0) == ivec2(ISF_SIZE);
    return is_alike ? texelFetch(image, ivec2(gl_FragCoord.xy), 0) : isf_sample(image, isf_norm_coord());
}

// A target of 8 bits cuts by itself; the picture holds floats.
vec4 isf_target(vec4 color) { return color; }
vec4 isf_display(vec4 color) { return mix(clamp(color, 0.0, 1.0), vec4(0.0), isnan(color)); }
vec4 isf_linear(vec4 color) {
    vec4 light = mix(color, vec4(0.0), isnan(color));
    float alpha = clamp(light.a, 0.0, 1.0);
    return vec4(has_coverage(alpha) ? light.rgb * alpha : light.rgb, alpha);
}
