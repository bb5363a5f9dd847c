// Pictures that need larger buffers than GL has are done in bands of rows.
#pragma once

#include <algorithm>
#include <cstddef>

namespace aftershade::visibility {

/// The least limit of storage blocks among GL's drivers.
inline constexpr std::size_t kMaxBufferBytes = std::size_t(128) << 20;
inline constexpr int kGroup = 64;         ///< local_size_x of the shaders
inline constexpr int kMaxGroups = 65535;  ///< GL's least limit

inline int group_count(std::size_t invocations) {
    return int((invocations + kGroup - 1) / kGroup);
}

/// Rows of a picture that are done at once; the last band may have fewer.
struct Bands {
    int height_px = 0;
    int rows = 1;

    /// Bands whose pixels need at most `max_bytes`, if not for fewer rows than `step`; each begins at a
    /// multiple of `step` rows.
    Bands(int width_px, int height, std::size_t bytes_of_row, int step, std::size_t max_bytes)
        : height_px(height) {
        const std::size_t by_memory = max_bytes / bytes_of_row;
        const std::size_t by_groups = std::size_t(kGroup) * kMaxGroups / std::size_t(width_px);
        rows = std::max(int(std::min({by_memory, by_groups, std::size_t(height)})) / step * step, step);
        rows = std::min(rows, height);
    }
    /// Calls work(first_row, rows).
    template <class Work>
    void for_each(const Work& work) const {
        for (int first = 0; first < height_px; first += rows) work(first, std::min(rows, height_px - first));
    }
};

}  // namespace aftershade::visibility
