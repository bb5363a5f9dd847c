#version 450 core
#include <pass>
#include <scattering/result.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_irradiance = scattered_result(p, texelFetch(estimate, p, 0).rgb);
}
