#include "mark.glsl"

// A texel of the texture light.
vec4 marked_light(ivec2 p) {
    vec3 light_here = texelFetch(surface, p, 0).rgb;
    float mark = mark_of(texelFetch(facet, p, 0).r);
    return mark > 0.0 ? vec4(light_here, mark) : vec4(0.0);
}
