#version 450 core
#include <pass>
#include "past.glsl"
#include "blur_frames.glsl"

#if GUIDING
const float kMostChange = 64.0;

// The blurred light of the frame before where the pixel was, between its pixels; false where that shows none of the object.
bool blurred_before(vec2 place, uint key, out vec3 light) {
    ivec2 base = ivec2(floor(place - 0.5));
    vec2 t = place - 0.5 - vec2(base);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1), at = clamp(base + step, ivec2(0), frame.size - 1);
        vec4 texel = texelFetch(blurred_prev, at, 0);
        vec2 near = mix(1.0 - t, t, vec2(step));
        if (texel.a == key_of(key)) sum += near.x * near.y * vec4(texel.rgb, 1.0);
    }
    light = sum.rgb / max(sum.a, 1e-20);
    return sum.a > 1e-3;
}
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    out_light_change = vec4(1.0, 1.0, 1.0, 0.0);
#ifdef HAS_LIGHT_CHANGE_BEFORE
    out_light_change = texelFetch(light_change_before, p, 0);
#endif
#if GUIDING
    uint key = texelFetch(facet, p, 0).r;
    vec3 before;
    if (key == 0u || !past_pixel(q) || !blurred_before(past_place(), key, before)) return;
    vec3 change = clamp(texelFetch(blurred, p, 0).rgb / max(before, 1e-20), 1.0 / kMostChange, kMostChange);
    out_light_change = vec4(change, texelFetch(guided, p, 0).a - kFramesOfBlur);
#endif
}
