// R2: points that fill the unit square evenly, whatever their number. u_i = fract(u_0 + i (1 / phi, 1 / phi^2)) with phi
// the real root of x^3 = x + 1. Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences.
//
// In units of 2^-32, so that point i is exact and wraps by itself: a float has lost its digits by i of some thousands.
#include <hash.glsl>

// round(2^32 / phi), round(2^32 / phi^2)
const uvec2 kR2Step = uvec2(0xC13FA9A9u, 0x91E10DA6u);

// Point i of the sequence that begins at `start`, which is its point 0.
uvec2 r2_bits(uvec2 start, uint i) { return start + i * kR2Step; }

// The same in (0, 1): its distance from 1 is at least 2^-24.
vec2 r2_point(uvec2 start, uint i) {
    uvec2 bits = r2_bits(start, i);
    return vec2(unit_float(bits.x), unit_float(bits.y));
}

// Where a pixel's own sequence begins (Cranley and Patterson 1976). `pixel` is of the display window at full scale; `key`
// the frame's number, or a hash of it with step and seed.
uvec2 r2_start(uvec2 pixel, uint key) { return pcg3d16(uvec3(pixel, key)).xy << 16u; }
