#version 450 core
#include <pass>
#include "layers.glsl"

layout(local_size_x = 1, local_size_y = 64) in;

shared uint any_share[kTile / kOccupied][kTile / kOccupied];

// One invocation sums one row of a tile: with sums that start anew every 64 px, 32-bit floats keep a uniform image uniform.
void main() {
    Layers layers = make_layers(texelFetch(range, ivec2(0), 0).rg);
    if (pass.index >= layer_count(layers)) return;
    int row = int(gl_LocalInvocationIndex), across = kTile / kOccupied;
    ivec2 cell = ivec2(row % across, row / across);
    if (cell.y < across) any_share[cell.y][cell.x] = 0u;
    barrier();
    ivec2 size = ivec2(color_size.xy);
    int y = int(gl_GlobalInvocationID.y), left = int(gl_WorkGroupID.x) * kTile;
    int end = y < size.y ? min(left + kTile, size.x) : left;
    vec4 light = vec4(0.0);
    vec2 share = vec2(0.0);
    for (int x = left; x < end; ++x) {
        float behind = float(pass.index) - layer_of(layers, texelFetch(coc, ivec2(x, y), 0).r);
        float seen = seen_in(behind), hidden = hidden_in(behind);
        if (seen > 0.0) light += seen * texelFetch(color, ivec2(x, y), 0);
        vec2 known = vec2(seen, seen_from(behind));
        if (hidden > 0.0) {
            vec3 at = vec3((vec2(x, y) + 0.5) * color_size.zw, float(pass.index));
            light += hidden * textureLod(hidden_light, at, 0.0);
            known += hidden * textureLod(hidden_share, at, 0.0).rg;
        }
        share += known;
        if (known.x > 0.0) any_share[row / kOccupied][(x - left) / kOccupied] = 1u;
        imageStore(sums, ivec3(x, y, pass.index), light);
        imageStore(shares, ivec3(x, y, pass.index), vec4(share, 0.0, 0.0));
    }
    barrier();
    if (cell.y < across)
        imageStore(occupied, ivec3(ivec2(gl_WorkGroupID.xy) * across + cell, pass.index), vec4(float(any_share[cell.y][cell.x])));
}
