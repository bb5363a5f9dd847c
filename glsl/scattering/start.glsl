#include <sequence.glsl>

// Where the pixel's own sequence of samples begins; another one for each `time`.
uvec2 samples_start(int seed, uint time) {
    uvec2 full = uvec2(floor((gl_FragCoord.xy + vec2(frame.origin)) / frame.scale));
    return r2_start(full, pcg3d(uvec3(time, frame.step_seed, seed)).x);
}
