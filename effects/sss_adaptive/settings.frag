#version 450 core
#include <pass>
#include <scattering/by_index.glsl>
#include <scattering/lines.glsl>
#include <hash.glsl>

uint mixed(uint hash, uvec4 bits) { return pcg3d(uvec3(hash ^ bits.x, bits.y, pcg3d(bits.zwx).x)).x; }

// A hash of what the blurs take but for the pixels: the lens, the unit and the taps.
void main() {
    ViewLines lines = view_lines();
    uint hash = mixed(uint(param.blur_samples), floatBitsToUint(vec4(lines.slope, lines.offset)));
    hash = mixed(hash ^ floatBitsToUint(param.world_unit), uvec4(0u));
    for (int index = 0; index < min(profile_count(), 1025); ++index)
        for (int tap = 0; tap < 32; ++tap) hash = mixed(hash, floatBitsToUint(texelFetch(half_kernel, ivec2(tap, index), 0)));
    out_settings = hash;
}
