#version 450 core
#include <pass>
#include "tile.glsl"

// A tile matters here if the gap between the two tiles is shorter than its largest radius.
void main() {
    ivec2 last = ivec2(near_tile_size.xy) - 1;
    ivec2 p = ivec2(gl_FragCoord.xy);
    int range = int(ceil(param.max_coc_radius / float(kTile)));
    float near = 0.0;
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            float radius = texelFetch(near_tile, ivec2(x, y), 0).r;
            int tiles_apart = max(max(abs(x - p.x), abs(y - p.y)), 1) - 1;
            if (radius > float(tiles_apart * kTile)) near = max(near, radius);
        }
    out_near = near;
}
