#version 450 core
#include <pass>
#include <scattering/mixed.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    uint key = texelFetch(place, p, 0).w;
    vec3 direct = scattering_profile(max(key, 1u) - 1u).direct * texelFetch(irradiance, p, 0).rgb;
    out_irradiance = mixed_result(p, key, texelFetch(sum, p, 0).rgb + direct);
}
