#version 450 core
#include <pass>
#define TAPS param.blur_samples
#define KEEPS_OWN 0
#include <scattering/blur.glsl>
#include "kept_key.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    Lit here = lit_at(p);
    vec3 light = blurred_light(view_lines(), p, here);
#if ALONG_ROWS
    out_rows = pack(Lit(light, here.depth_m, here.key));
#else
    out_blurred = vec4(light, key_of(here.key));
#endif
}
