#version 450 core
#include <pass>
#include <scattering/filled.glsl>
#include <scattering/result.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_irradiance = scattered_result(p, filled(texelFetch(guided, p, 0).rgb, texelFetch(guided_share, p, 0).rgb));
}
