#version 450 core
#include <pass>
#include "reach.glsl"

// A blur takes light from a tile if it reaches the tile, or the tile beside it with the outermost texels of a coarse level.
void main() {
    ivec2 last = ivec2(around_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    float widest_px = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) widest_px = max(widest_px, widest_radius_px(texelFetch(around, clamp(p + ivec2(x, y), ivec2(0), last), 0)));
    out_lit = widest_px >= kLeastBlurPx ? 1.0 : 0.0;
}
