#version 450 core
#include <pass>
#include "edges.glsl"

float behind_edge(float a, float b) { return is_repaired(abs(a - b)) ? max(a, b) : kNoEdge; }

void main() {
    ivec2 block = ivec2(gl_FragCoord.xy), corner = kBlock * block, last = frame.size - 1;
    int side = has_edges(corner / kTile) ? kBlock : -1;
    out_edges = kNoEdge;
    for (int y = -1; y < side; ++y)
        for (int x = -1; x < side; ++x) {
            ivec2 p = clamp(corner + ivec2(x, y), ivec2(0), last);
            float own = texelFetch(lit_coc, p, 0).r;
            float right = texelFetch(lit_coc, min(p + ivec2(1, 0), last), 0).r, below = texelFetch(lit_coc, min(p + ivec2(0, 1), last), 0).r;
            out_edges = max(out_edges, max(behind_edge(own, right), behind_edge(own, below)));
        }
}
