#version 450 core
#include <pass>
#define TAPS param.samples
#define KEEPS_OWN (MISSING == MISSING_OWN)
#include <scattering/blur.glsl>
#if !ALONG_ROWS
#include <scattering/result.glsl>
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Lit here = lit_at(p);
    vec3 blurred = blurred_light(view_lines(), p, here);
#if ALONG_ROWS
    out_rows = pack(Lit(blurred, here.depth_m, here.key));
#else
    out_irradiance = scattered_result(p, blurred);
#endif
}
