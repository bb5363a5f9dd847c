#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include <lens/highlight.glsl>
#include "tile.glsl"

void main() {
    ivec2 last = ivec2(light_size.xy) - 1, corner = kTile * ivec2(gl_FragCoord.xy);
    vec4 largest = vec4(0.0);
    for (int y = 0; y < kTile; ++y)
        for (int x = 0; x < kTile; ++x) {
            Light pixel = unpack_light(texelFetch(light, min(corner + ivec2(x, y), last), 0));
            largest.x = max(largest.x, -pixel.coc);
#ifdef HAS_BEHIND
            pixel = unpack_light(texelFetch(behind, min(corner + ivec2(x, y), last), 0));
#endif
            largest.y = max(largest.y, pixel.coc);
            float spread = amount(pixel.color.rgb) / max(kPi * pixel.coc * pixel.coc, kLeastSpreadPx);
            if (pixel.coc >= kLeastBlurPx && spread > largest.z) largest.zw = vec2(spread, pixel.coc);
        }
    out_tile_coc = largest;
}
