#version 450 core
#include <pass>

const int kTile = 16;

void main() {
    ivec2 last = ivec2(tile_size.xy) - 1;
    ivec2 p = ivec2(gl_FragCoord.xy);
    int range = int(ceil(param.max_blur / float(kTile)));
    float nearest = -1.0;
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x) {
            // From that tile to this one, px: the shortest way along each axis.
            vec2 away = float(kTile) * vec2(p - ivec2(x, y));
            vec4 reach = texelFetch(tile_reach, ivec2(x, y), 0);
            bool comes_over = all(lessThan(away - float(kTile), reach.zw)) && all(greaterThan(away + float(kTile), reach.xy));
            if (comes_over) nearest = max(nearest, texelFetch(tile, ivec2(x, y), 0).r);
        }
    out_near = nearest;
}
