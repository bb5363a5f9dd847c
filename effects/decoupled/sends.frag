#version 450 core
#include <pass>
#include "tiles.glsl"

void main() {
    ivec2 last = ivec2(meet_size.xy) - 1, p = ivec2(gl_FragCoord.xy);
    // What is hidden moves as far as what may reach it.
    vec2 reach_px = vec2(texelFetch(reach_tile, p, 0).r, texelFetch(reach, p, 0).r), sends_here = vec2(0.0);
    int range = int(ceil(reach_px.y / float(kTile))) + 1;
    for (int y = max(p.y - range, 0); y <= min(p.y + range, last.y); ++y)
        for (int x = max(p.x - range, 0); x <= min(p.x + range, last.x); ++x)
            if (texelFetch(meet, ivec2(x, y), 0).r > 0.0) sends_here = max(sends_here, step(gap_px(ivec2(x, y) - p) - 1.0, reach_px));
    out_sends = sends_here;
}
