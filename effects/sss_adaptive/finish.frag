#version 450 core
#include <pass>
#include <scattering/gathered.glsl>
#include <scattering/result.glsl>
#include "hybrid_result.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef HAS_GUIDED
    Gathered sums = Gathered(texelFetch(guided, p, 0).rgb, texelFetch(guided_share, p, 0).rgb, texelFetch(guided_whole, p, 0).rgb);
    vec3 drawn = in_part(texelFetch(surface, p, 0).rgb, filled(sums), texelFetch(plan, p, 0).z);
#else
    vec3 drawn = texelFetch(estimate, p, 0).rgb;
#endif
    out_irradiance = scattered_result(p, hybrid_result(p, drawn));
}
