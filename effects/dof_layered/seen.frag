#version 450 core
#include <pass>
#include "layers.glsl"
#include <lens/highlight.glsl>
#include <lens/own.glsl>

// Highlights are weighted down: behind an object, one that was never seen would stand out.
void main() {
    Layers layers = make_layers(texelFetch(range, ivec2(0), 0).rg);
    ivec2 corner = ivec2(gl_FragCoord.xy) * 4, end = min(corner + 4, ivec2(color_size.xy));
    vec4 light = vec4(0.0);
    vec2 share = vec2(0.0);
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            float behind = float(pass.index) - layer_of(layers, texelFetch(coc, ivec2(x, y), 0).r);
            vec4 here = own_color(ivec2(x, y));
            float weight = 1.0 / (1.0 + max(amount(here.rgb), 0.0));
            light += weight * seen_in(behind) * here;
            share += weight * vec2(seen_in(behind), seen_from(behind));
        }
    out_seen_light = light / 16.0;
    out_seen_share = share / 16.0;
}
