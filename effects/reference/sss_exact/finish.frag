#version 450 core
#include <pass>
#include <scattering/filled.glsl>
#include <scattering/result.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 light = texelFetch(sum, p, 0).rgb, found = texelFetch(share, p, 0).rgb;
    out_irradiance = scattered_result(p, filled(light, found));
}
