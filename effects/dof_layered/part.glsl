// Part of a layer: its light, its opacity, and how much is known about it.
#include "layers.glsl"

struct Part {
    vec4 light;
    vec2 share;
};

// What one pixel is in the layer of this pass: what is seen there, or the push-pull behind it.
Part part_at(ivec2 p, Layers layers) {
    float behind = float(pass.index) - layer_of(layers, texelFetch(coc, p, 0).r);
    float seen = seen_in(behind), hidden = hidden_in(behind);
    Part part = Part(vec4(0.0), vec2(seen, seen_from(behind)));
    if (seen > 0.0) part.light = seen * texelFetch(color, p, 0);
    if (hidden > 0.0) {
        vec3 at = vec3((vec2(p) + 0.5) * color_size.zw, float(pass.index));
        part.light += hidden * textureLod(hidden_light, at, 0.0);
        part.share += hidden * textureLod(hidden_share, at, 0.0).rg;
    }
    return part;
}
