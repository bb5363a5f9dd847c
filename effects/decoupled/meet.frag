#version 450 core
#include <pass>
#include "met.glsl"
#include "tiles.glsl"

// Where nothing hides anything, one blur after the other is as good as both at once.
void main() {
    ivec2 last = ivec2(reach_tile_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    vec2 most_px = vec2(0.0);
    float has_silhouette = 0.0;
    int range = int(ceil(texelFetch(reach, p, 0).r / float(kTile)));
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            vec2 tile = texelFetch(reach_tile, ivec2(x, y), 0).rg;
            if (tile.r <= gap_px(ivec2(x, y) - p)) continue;
            most_px = max(most_px, texelFetch(blurs, ivec2(x, y), 0).rg);
            has_silhouette = max(has_silhouette, tile.g);
        }
    out_meet = has_silhouette > 0.0 && all(greaterThan(most_px, kTracedPx)) ? min(most_px.x, most_px.y) : 0.0;
}
