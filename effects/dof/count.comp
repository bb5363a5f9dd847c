#version 450 core
#include <pass>
#include "tile.glsl"

layout(local_size_x = 1) in;

void main() {
    ivec2 tile = ivec2(gl_WorkGroupID.xy), corner = kTile * tile, end = min(corner + kTile, frame.size);
    uint count = 0u;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x)
            if (texelFetch(highlight, ivec2(x, y), 0).rgb != vec3(0.0)) ++count;
    tile_count[tile.y * int(gl_NumWorkGroups.x) + tile.x] = count;
}
