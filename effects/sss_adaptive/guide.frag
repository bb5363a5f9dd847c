#version 450 core
#include <pass>
#include "past.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), q;
    bool inside = past_pixel(q);
    vec3 now = texelFetch(estimate, p, 0).rgb;
    vec4 past = texelFetch(guided_prev, q, 0);
    bool known = inside && texelFetch(plan, p, 0).y > 0.0 && past.a > 0.0;
    // Frames count alike until the newest would count less than its weight.
    float frames = known ? past.a + 1.0 : 1.0;
    float weight = max(1.0 / frames, param.guiding_weight);
    out_guided = texelFetch(facet, p, 0).r == 0u ? vec4(0.0) : vec4(known ? mix(past.rgb, now, weight) : now, 1.0 / weight);
}
