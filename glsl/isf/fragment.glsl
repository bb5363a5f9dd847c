#include <isf/images.glsl>
#include <coverage.glsl>

vec4 isf_data[1] = vec4[](vec4(0.0));
vec4 isf_FragCoord = vec4(gl_FragCoord.x, ISF_SIZE.y - gl_FragCoord.y, gl_FragCoord.zw);
#ifdef ISF_MOVED
in vec2 isf_norm;
vec2 isf_FragNormCoord = isf_norm;
#else
vec2 isf_FragNormCoord = isf_FragCoord.xy / ISF_SIZE;
#endif
// What an output of the file's own holds.
vec4 isf_color(vec4 color) { return color; }
vec4 isf_color(vec3 color) { return vec4(color, 1.0); }

// What the file reads by its pixel is a value where that can be.
vec4 IMG_THIS_PIXEL(vec4 texel) { return texel; }
vec4 IMG_THIS_NORM_PIXEL(vec4 texel) { return texel; }
vec4 IMG_THIS_PIXEL(sampler2D image) { return isf_sample(image, isf_FragNormCoord); }
ivec2 isf_pixel = ivec2(gl_FragCoord.xy);
vec4 IMG_THIS_NORM_PIXEL(sampler2D image) { return IMG_THIS_PIXEL(image); }

// A target of 8 bits cuts by itself; the picture holds floats. clamp() to 0 and 1 is a saturation, which makes 0 of what is not a
// number on llvmpipe and on GPUs.
vec4 isf_target(vec4 color) { return color; }
vec4 isf_display(vec4 color) { return clamp(color, 0.0, 1.0); }
vec4 isf_linear(vec4 color) {
    vec4 light = mix(color, vec4(0.0), isnan(color));
    float alpha = clamp(light.a, 0.0, 1.0);
    return vec4(has_coverage(alpha) ? light.rgb * alpha : light.rgb, alpha);
}
