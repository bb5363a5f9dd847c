#version 450 core
#include <pass>
#include <lens/packing.glsl>
#include <near_reach/tile.glsl>

// As the module near_reach has it, of `light` without what is in `front`.
void main() {
    ivec2 last = ivec2(light_size.xy) - 1, corner = ivec2(gl_FragCoord.xy) * kTile;
    float near = 0.0;
    for (int y = 0; y < kTile; ++y)
        for (int x = 0; x < kTile; ++x) near = max(near, -unpack_light(texelFetch(light, min(corner + ivec2(x, y), last), 0)).coc);
    out_behind_tile = near;
}
