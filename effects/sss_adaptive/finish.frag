#version 450 core
#include <pass>
#include <scattering/filled.glsl>
#include <scattering/result.glsl>
#include "hybrid_result.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef HAS_GUIDED
    vec3 drawn = filled(texelFetch(guided, p, 0).rgb, texelFetch(guided_share, p, 0).rgb);
#else
    vec3 drawn = texelFetch(estimate, p, 0).rgb;
#endif
    out_irradiance = scattered_result(p, hybrid_result(p, drawn));
}
