#version 450 core
#include <pass>
#include "foreground.glsl"

// Where light in front is nearly opaque, the little of what is behind would be mostly rounding.
const float kOpaque = 0.98;

vec4 color_of(ivec2 p) { return texelFetch(color, p, 0); }

// `in` may name a `color` that a later step has changed: no more is taken from it than it has.
vec4 veil_of(ivec2 p) {
    vec4 over = texelFetch(foreground, p, 0);
    return vec4(min(over.rgb, max(color_of(p).rgb, vec3(0.0))), over.a);
}

vec4 without(vec4 over, ivec2 p) {
    vec4 all = color_of(p);
    return (all - vec4(over.rgb, alpha_of_light(over.a, all.a))) / (1.0 - over.a);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), behind = covered_by_light(p);
    vec4 over = veil_of(p), over_behind = veil_of(behind);
    out_veil = over;
    out_clean = over.a < kOpaque ? without(over, p) : over_behind.a < kOpaque ? without(over_behind, behind) : color_of(behind);
}
