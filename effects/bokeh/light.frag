#version 450 core
#include <pass>
#include <lens/highlight.glsl>
#include <lens/packing.glsl>
#include "outline.glsl"

#ifdef HAS_SURROUNDINGS
// How far a texel is a highlight: 1 where it outshines the mean of a square of four CoC radii by far. Like what a
// minimum of parallelograms loses, it falls with the size of the light: a disk of half the CoC radius is 0.8 of one, and
// loses 0.9 of what a point does.
float highlight(vec3 rgb, float radius) {
    float level = log2(max(radius, 2.0) / 2.0);
    vec2 at = gl_FragCoord.xy * (surroundings_size.zw / 8.0);
    float own = amount(rgb), around = max(amount(textureLod(surroundings, at, level).rgb), 0.0);
    return own > kHighlight * around ? 1.0 - kHighlight * around / own : 0.0;
}

float gain(vec3 rgb, float radius) {
    float blurred = clamp((radius - 0.5) / 1.5, 0.0, 1.0);  // what is in focus loses nothing
    return 1.0 + param.highlight_gain * (1.0 / kept_energy() - 1.0) * blurred * highlight(rgb, radius);
}
#else
float gain(vec3 rgb, float radius) { return 1.0; }
#endif

#ifdef HAS_OUT_FRONT
#include "front.glsl"
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(color, p, 0);
    float radius = texelFetch(coc, p, 0).r;
#ifdef HAS_OUT_FRONT
    Parted parted = parted_at(p, texel, radius);
    out_front = pack_light(parted.front);
    texel = parted.behind.color;
    radius = parted.behind.coc;
#endif
    out_light = pack_light(Light(vec4(texel.rgb * gain(texel.rgb, abs(radius)), texel.a), radius));
}
