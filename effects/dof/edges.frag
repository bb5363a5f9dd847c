#version 450 core
#include <pass>
#include "edges.glsl"

float behind_edge(float a, float b) { return is_repaired(abs(a - b)) ? max(a, b) : kNoEdge; }

void main() {
    ivec2 block = ivec2(gl_FragCoord.xy), corner = kBlock * block, last = frame.size - 1;
    bool are_edges = has_edges(corner / kTile);
    int side = are_edges ? kBlock : -1;
    vec2 range_px = texelFetch(tile_coc, corner / kTile, 0).rg;
    out_edges = vec2(kNoEdge, are_edges ? kNoNarrow : narrow_of(range_px.x, range_px.y));
    for (int y = -1; y < side; ++y)
        for (int x = -1; x < side; ++x) {
            ivec2 p = clamp(corner + ivec2(x, y), ivec2(0), last);
            float own = texelFetch(lit_coc, p, 0).r;
            float right = texelFetch(lit_coc, min(p + ivec2(1, 0), last), 0).r, below = texelFetch(lit_coc, min(p + ivec2(0, 1), last), 0).r;
            out_edges.r = max(out_edges.r, max(behind_edge(own, right), behind_edge(own, below)));
            out_edges.g = min(out_edges.g, narrow_of(own, own));
        }
}
