#version 450 core
#include <pass>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 before = texelFetch(irradiance, p, 0);
    uint key = texelFetch(place, p, 0).w;
    vec3 after = texelFetch(sum, p, 0).rgb + scattering_profile(max(key, 1u) - 1u).direct * before.rgb;
#ifdef HAS_MASK
    after = mix(before.rgb, after, clamp(texelFetch(mask, p, 0).r, 0.0, 1.0));
#endif
    out_irradiance = key == 0u ? before : vec4(after, before.a);
}
