#version 450 core
#include <pass>
#include <scattering/facet.glsl>
#include "moments.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    past_pixel(q);
    Facet here = read_facet(view_lines(), p);
    vec4 planned = texelFetch(plan, p, 0), drawn = texelFetch(estimate, p, 0);
    float value = exposed(drawn.rgb);
#if CONTROL_VARIATE == CONTROL_VARIATE_CONSTANT
    value -= exposed(here.light);
#endif
    vec4 after = updated_history(texelFetch(history_prev, q, 0), planned.y > 0.0, drawn.a, value, here.key);
    bool followed = here.key != 0u && planned.y >= 0.0;
    out_history = followed ? after : vec4(0.0);
}
