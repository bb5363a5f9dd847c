#version 450 core
#include <pass>
#include "outline.glsl"
#include "packing.glsl"

// How far a texel is a highlight: 1 where it outshines the mean of a square of four CoC radii by far. Like what a
// minimum of parallelograms loses, it falls with the size of the light: a disk of half the CoC radius is 0.8 of one, and
// loses 0.9 of what a point does.
float highlight(Light light) {
    float level = log2(max(abs(light.coc), 2.0) / 2.0);
    vec2 at = gl_FragCoord.xy * (surroundings_size.zw / 8.0);
    float own = amount(light.rgb), around = max(amount(textureLod(surroundings, at, level).rgb), 0.0);
    return own > kHighlight * around ? 1.0 - kHighlight * around / own : 0.0;
}

void main() {
    Light centre = unpack_light(texelFetch(light, ivec2(gl_FragCoord.xy), 0));
    if (param.highlight_gain > 0.0) {
        float blurred = clamp((abs(centre.coc) - 0.5) / 1.5, 0.0, 1.0);  // what is in focus loses nothing
        float lost = 1.0 / kept_energy() - 1.0;
        centre.rgb *= 1.0 + param.highlight_gain * lost * blurred * highlight(centre);
    }
    out_light = pack_light(centre);
}
