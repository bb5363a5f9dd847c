#include <coverage.glsl>
#include <srgb.glsl>
#include <luminance.glsl>

// The picture as dim grey, so that only data has colours.
vec3 dimmed_picture(ivec2 p) {
    vec3 encoded = vec3(0.0);
#if defined(HAS_DISPLAY)
    encoded = texelFetch(display, p, 0).rgb;
#elif defined(HAS_COLOR)
    vec4 texel = texelFetch(color, p, 0);
    vec3 light = frame.rec709_from_color * straight_light(texel);
    encoded = encode_srgb(clamp(light, 0.0, 1.0));
#endif
    float grey = luminance(encoded);
    return vec3(isnan(grey) ? 0.0 : param.picture * clamp(grey, 0.0, 1.0));
}
