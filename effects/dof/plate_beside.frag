#version 450 core
#include <pass>
#include "coarse.glsl"
#include "patch_texels.glsl"
#include "near_tile.glsl"

// The clean plate at half size, below the other.
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy) - ivec2(0, room_row()), last = textureSize(plate_half, 0) - 1;
    bool is_drawn = all(lessThanEqual(p, last)) && is_near(2 * p / kTile);
    out_plate = is_drawn ? pack_plate(texelFetch(plate_half, min(p, last), 0)) : uvec4(0u);
}
