#version 450 core
#include <pass>
#include <near_reach/tile.glsl>

void main() {
    ivec2 last = ivec2(behind_tile_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    int range = int(ceil(param.max_coc_radius / float(kTile)));
    float near = 0.0;
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            float radius = texelFetch(behind_tile, ivec2(x, y), 0).r;
            int tiles_apart = max(max(abs(x - p.x), abs(y - p.y)), 1) - 1;
            if (radius > float(tiles_apart * kTile)) near = max(near, radius);
        }
    out_behind_near = near;
}
