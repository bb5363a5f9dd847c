// The twin of glsl/hash.glsl and glsl/sequence.glsl. Integers: equal bit by bit. All functions are pure and
// may be called from any thread.
#pragma once

#include <array>
#include <cstdint>

namespace aftershade::reference {

using Uvec2 = std::array<std::uint32_t, 2>;
using Uvec3 = std::array<std::uint32_t, 3>;

namespace detail {
inline void stir(Uvec3& v) {
    v[0] += v[1] * v[2];
    v[1] += v[2] * v[0];
    v[2] += v[0] * v[1];
}
}  // namespace detail

/// Three numbers of 32 bits: Jarzynski and Olano 2020, Hash Functions for GPU Rendering, JCGT 9(3).
inline Uvec3 pcg3d(Uvec3 v) {
    for (std::uint32_t& item : v) item = item * 1664525u + 1013904223u;
    detail::stir(v);
    for (std::uint32_t& item : v) item ^= item >> 16u;
    detail::stir(v);
    return v;
}

/// Three numbers of 16 bits, from the same.
inline Uvec3 pcg3d16(Uvec3 v) {
    for (std::uint32_t& item : v) item = item * 12829u + 47989u;
    detail::stir(v);
    detail::stir(v);
    for (std::uint32_t& item : v) item >>= 16u;
    return v;
}

/// In (0, 1), exact in a float: the upper 23 bits and a half.
inline float unit_float(std::uint32_t bits) {
    return (float(bits >> 9u) + 0.5f) * (1.0f / 8388608.0f);
}

/// Point i of the R2 sequence that begins at `start`, in units of 2^-32 (Roberts 2018).
inline Uvec2 r2_bits(const Uvec2& start, std::uint32_t i) {
    return {start[0] + i * 0xC13FA9A9u, start[1] + i * 0x91E10DA6u};
}

/// The same in (0, 1).
inline std::array<float, 2> r2_point(const Uvec2& start, std::uint32_t i) {
    const Uvec2 bits = r2_bits(start, i);
    return {unit_float(bits[0]), unit_float(bits[1])};
}

/// Where a pixel's own sequence begins.
inline Uvec2 r2_start(const Uvec2& pixel, std::uint32_t key) {
    const Uvec3 hash = pcg3d16({pixel[0], pixel[1], key});
    return {hash[0] << 16u, hash[1] << 16u};
}

}  // namespace aftershade::reference
