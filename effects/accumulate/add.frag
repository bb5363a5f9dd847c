#version 450 core
#include <pass>
#include "weights.glsl"

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 light = texelFetch(color, p, 0);
    vec4 before = texelFetch(mean_prev, p, 0), rest_before = texelFetch(rest_prev, p, 0);
    // Kahan 1965: what an addition rounds away goes into the next one.
    precise vec4 change = (light - before) * share(frame.subframe, frame.subframe_count) + rest_before;
    precise vec4 sum = before + change;
    precise vec4 rounded = change - (sum - before);
    bool first = frame.subframe == 0;
    out_mean = first ? light : sum;
    out_rest = first ? vec4(0.0) : rounded;
}
