#version 450 core
#include <pass>
#include <scattering/facet.glsl>

vec3 light_of_sample(Facet there, vec2 place, float area_px) { return there.light; }

#include <scattering/gather.glsl>
#include <scattering/result.glsl>

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ViewLines lines = view_lines();
    Facet here = read_facet(lines, p);
    out_irradiance = texelFetch(irradiance, p, 0);
    if (here.key == 0u) return;
    Gathered sums = gathered(lines, p, here, samples_start(param.seed, uint(frame.number)), param.samples);
    out_irradiance = scattered_result(p, filled(sums));
}
