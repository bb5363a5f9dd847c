#include <hash.glsl>

// Of the frame and the step.
uvec3 grain_key() { return pcg3d(uvec3(uint(frame.number), frame.step_seed, uint(param.seed))); }

// Standard normal numbers of one grain, which has its place in the display window.
vec3 one_grain(ivec2 cell, uvec3 key) {
    uvec3 a = pcg3d(uvec3(uvec2(cell), key.x));
#if MONOCHROME
    return vec3(normal_pair(a.x, a.y).x);
#else
    uvec3 b = pcg3d(uvec3(uvec2(cell), key.y));
    return vec3(normal_pair(a.x, a.y), normal_pair(a.z, b.x).x);
#endif
}
