// Frames come in epochs. Over one, a pixel takes points of a single R2 sequence, each frame the next ones: together they fill
// the square far more evenly than as many sets of a frame's few. How many a frame takes is decided before the epoch begins:
// decided by draws of the epoch itself, which tell where the next points lie, it would pull the mean.
#include <hash.glsl>
#include <scattering/start.glsl>

const int kEpochLog2 = 3;
const int kEpoch = 1 << kEpochLog2;  // frames

int frame_of_epoch() { return frame.number & (kEpoch - 1); }

// The epoch for hashes: no frame's number.
uint epoch_time() { return uint(frame.number >> kEpochLog2) ^ 0x80000000u; }

// Random numbers of a block of 4 x 4 px, which a processor draws together: all wait for the one that takes most.
uvec3 block_hash(uint time) {
    uvec2 block = uvec2(floor((gl_FragCoord.xy + vec2(frame.origin)) / frame.scale)) / 4u;
    return pcg3d(uvec3(block, pcg3d(uvec3(time, frame.step_seed, param.seed + 65536)).x));
}

// Samples that an epoch of `each` samples a frame, not always whole, has taken before the frame after `frames` of them.
float taken_before(float each, int frames) { return floor(each * float(frames) + unit_float(block_hash(epoch_time()).x)); }

// The frame's first point. `each`: of the texture epoch.
uvec2 first_point(float each) {
    if (each == 0.0) return samples_start(param.seed, uint(frame.number));
    return r2_bits(samples_start(param.seed, epoch_time()), uint(taken_before(each, frame_of_epoch())));
}
