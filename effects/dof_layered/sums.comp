#version 450 core
#include <pass>
#include "part.glsl"

layout(local_size_x = 1, local_size_y = 32) in;

shared uint any_share[kTile / kOccupied][kTile / kOccupied];

// One invocation sums one row of a tile: with sums that restart every 32 px and keep what rounding takes (Kahan), 32-bit
// floats keep a uniform image uniform.
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
    vec4 light, lost_light;
    vec2 share, lost_share;
    for (int x = left; x < end; ++x) {
        if (starts_run(x, size.x)) {
            light = lost_light = vec4(0.0);
            share = lost_share = vec2(0.0);
        }
        Part own = part_at(ivec2(x, y), layers);
        precise vec4 light_term = own.light - lost_light, next_light = light + light_term;
        precise vec2 share_term = own.share - lost_share, next_share = share + share_term;
        lost_light = (next_light - light) - light_term;
        lost_share = (next_share - share) - share_term;
        light = next_light;
        share = next_share;
        if (own.share.x > 0.0) any_share[row / kOccupied][(x - left) / kOccupied] = 1u;
        imageStore(sums, ivec3(x, y, pass.index), light);
        imageStore(shares, ivec3(x, y, pass.index), vec4(share, 0.0, 0.0));
    }
    barrier();
    if (cell.y < across)
        imageStore(occupied, ivec3(ivec2(gl_WorkGroupID.xy) * across + cell, pass.index),
                   vec4(float(any_share[cell.y][cell.x])));
}
