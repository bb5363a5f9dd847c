#include <hash.glsl>

// In (0, 1), another for each pixel at full scale, frame and step.
float random_phase() {
    ivec2 full = ivec2(floor((gl_FragCoord.xy + vec2(frame.origin)) / frame.scale));
    uvec3 key = pcg3d(uvec3(uint(frame.number), frame.step_seed, 0u));
    return unit_float(pcg3d(uvec3(uvec2(full), key.x)).x);
}
