#version 450 core
#include <pass>
#include "tile.glsl"

// A tile matters here if the gap between the two tiles is shorter than its largest radius.
void main() {
    ivec2 last = ivec2(near_tile_size.xy) - 1;
    ivec2 p = ivec2(gl_FragCoord.xy);
    int range = int(ceil(param.max_coc_radius / float(kTile)));
    ivec2 from = max(p - range, ivec2(0)), to = min(p + range, last), q = from;
    float near = 0.0;
    do {
        q.x = from.x;
        do {
            float radius = texelFetch(near_tile, q, 0).r;
            int tiles_apart = max(max(abs(q.x - p.x), abs(q.y - p.y)), 1) - 1;
            if (radius > float(tiles_apart * kTile)) near = max(near, radius);
        } while (++q.x <= to.x);
    } while (++q.y <= to.y);
    out_near = near;
}
