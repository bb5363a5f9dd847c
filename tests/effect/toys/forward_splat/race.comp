#version 450 core
#include <pass>
#include "splat.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!inside(p)) return;
    ivec2 thrown = throw_of(p);
    if (inside(p + thrown)) imageAtomicMin(nearest, p + thrown, key_of(p, thrown));
}
