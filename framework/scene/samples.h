// Samples of the pixel's area and the lens: deterministic, by hashes.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace aftershade::scene {

/// Jarzynski and Olano 2020, Hash Functions for GPU Rendering: pcg3d. The twin of glsl/hash.glsl.
std::array<std::uint32_t, 3> pcg3d(std::uint32_t x, std::uint32_t y, std::uint32_t z);

/// The seed of the random rays for light at a shading sample (its id and 0), or at one visibility sample (the
/// pixel's seed and the sample's number).
std::uint32_t light_seed(std::uint32_t id, std::uint32_t sample);

/// A permutation of [0, count), by `seed`.
std::uint32_t permuted(std::uint32_t index, std::uint32_t count, std::uint32_t seed);

/// Sample `index` of `count` over the unit square: one in each cell of a grid, and in each row and column of
/// the finer grids that the cells' columns and rows make (multi-jittered: Chiu, Shirley and Wang 1994; by
/// hashes as Kensler 2013). Where `count` has no such grid, the last cells stay empty.
glm::dvec2 multi_jittered(std::uint32_t index, std::uint32_t count, std::uint32_t seed);

/// Point `index` of `count` of Hammersley's set, shifted at random around the unit square (Cranley and
/// Patterson 1976). Unlike multi_jittered() it fills the square evenly for any `count`.
glm::dvec2 shifted_hammersley(std::uint32_t index, std::uint32_t count, std::uint32_t seed);

/// The unit square onto the aperture, of circumradius 1, evenly by area: a disk for 0 blades (Shirley and
/// Chiu 1997), else a polygon with the middle of a straight edge at +x, which `rotation_rad` turns towards
/// +y (down in the picture).
glm::dvec2 on_aperture(const glm::dvec2& u, int blades, double rotation_rad);

/// The radical inverses of `index` (from 1) in bases 2 and 3, minus a half (Halton 1960): camera jitter, px.
std::array<double, 2> halton_jitter_px(int index);

}  // namespace aftershade::scene
