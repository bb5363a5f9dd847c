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
    vec4 past = texelFetch(history_prev, q, 0);
    vec4 after = updated_history(past, planned.y > 0.0 && past.x >= 0.0, drawn.a, value, here.key);
    out_history = here.key == 0u ? vec4(0.0) : planned.y < 0.0 ? unsampled_history(here.key) : after;
}
