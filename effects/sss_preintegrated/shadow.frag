#version 450 core
#include <pass>
#include <lighting/lighting.glsl>
#include "shadow.glsl"

// The share of the lights' light that arrives: what came in over what would come without anything in the way.
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint key = texelFetch(facet, at, 0).r;
    vec4 point = texelFetch(surface, at, 0);
    vec3 n = texelFetch(normal, at, 0).xyz;
    vec3 position_m = world_position_m(gl_FragCoord.xy, point.a);
    vec3 sum = vec3(0.0), facing = vec3(0.0);
    for (int i = 0; i < light_count(); ++i) {
        Arriving one = arriving(i, position_m);
        sum += one.light * max(dot(n, one.toward), 0.0);
        facing += one.light;
    }
    Shadow shadow;
    shadow.seen = seen_share(point.rgb, sum);
    // Beyond the terminator and just before it nothing can be told.
    float all = facing.r + facing.g + facing.b;
    shadow.trust = key != 0u && all > 0.0 ? clamp(10.0 * (sum.r + sum.g + sum.b) / all, 0.0, 1.0) : 0.0;
    shadow.depth_m = point.a;
    shadow.key = key;
    out_shadow = packed_shadow(shadow);
}
