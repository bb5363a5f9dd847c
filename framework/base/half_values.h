// Floats as halfs and back, by instructions that the processor has for it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace aftershade {

/// Whether it has them (F16C); without, do not call the others.
bool converts_halfs();
/// Whether each of `count` values, a multiple of 4, is a half with the same bits as a float; else `halfs` is
/// undefined.
bool to_exact_halfs(const float* values, std::uint16_t* halfs, std::size_t count);
/// The same back. A signalling NaN becomes a quiet one.
void from_halfs(const std::uint16_t* halfs, float* values, std::size_t count);

}  // namespace aftershade
