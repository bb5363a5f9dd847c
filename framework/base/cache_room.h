// The bound of a folder that several processes keep files in.
#pragma once

#include <cstdint>
#include <filesystem>

namespace aftershade {

/// Removes the files of `folder` for which `is_of_cache` is true, the oldest first, until the rest has at
/// most `max_bytes`. A file that another process removes meanwhile, or that cannot be removed, is left as it
/// is.
void make_cache_room(const std::filesystem::path& folder, std::uint64_t max_bytes,
                     bool (*is_of_cache)(const std::filesystem::path& file));

}  // namespace aftershade
