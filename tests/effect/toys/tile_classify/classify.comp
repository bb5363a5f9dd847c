#version 450 core
#include <pass>
#include "tile.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

shared uint brightest;  // bits of a float that is not negative: they order as it does

void main() {
    if (gl_LocalInvocationIndex == 0u) brightest = 0u;
    barrier();
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, frame.size))) {
        vec3 rgb = texelFetch(color, p, 0).rgb;
        atomicMax(brightest, floatBitsToUint(max(max(rgb.r, rgb.g), max(rgb.b, 0.0))));
    }
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    uint tile = tile_number(ivec2(gl_WorkGroupID.xy));
    if (uintBitsToFloat(brightest) > param.threshold) bright_list[atomicAdd(bright_args[1], 1u)] = tile;
    else dark_list[atomicAdd(dark_args[1], 1u)] = tile;
}
