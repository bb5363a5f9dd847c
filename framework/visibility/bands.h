// Rows that fit into buffers; for the sources of this folder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "framework/gpu/buffer.h"
#include "framework/scene/shading_cache.h"

namespace aftershade::visibility {

inline constexpr int kGroup = 64;         ///< local_size_x of the shaders
inline constexpr int kMaxGroups = 65535;  ///< GL's least limit

inline int group_count(std::size_t invocations) {
    return int((invocations + kGroup - 1) / kGroup);
}

/// Calls work(first_row, rows) for bands whose pixels need at most `max_bytes`, if not for fewer rows than
/// `step`; each begins at a multiple of `step` rows.
template <class Work>
void for_each_band(int width_px, int height_px, std::size_t bytes_of_row, int step, std::size_t max_bytes,
                   const Work& work) {
    const std::size_t by_memory = max_bytes / bytes_of_row;
    const std::size_t by_groups = std::size_t(kGroup) * kMaxGroups / std::size_t(width_px);
    const int rows =
        std::max(int(std::min({by_memory, by_groups, std::size_t(height_px)})) / step * step, step);
    for (int first = 0; first < height_px; first += rows) work(first, std::min(rows, height_px - first));
}

template <class T>
std::span<const std::byte> bytes_of(const T& values) {
    return std::as_bytes(std::span(values));
}

}  // namespace aftershade::visibility
