// Names for contents: XXH3-128 over bytes and files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace aftershade {

/// 32 hexadecimal digits of XXH3 with 128 bits, the same on every machine. It finds changes and damage; it
/// does not resist intent. [thread-safe]
std::string content_hash(std::string_view bytes);

struct FileContent {
    std::uint64_t bytes = 0;
    std::string hash;  ///< as content_hash gives it
};

/// Reads the whole file. Throws Error(ErrorKind::capture) naming it and the system's reason. [thread-safe]
FileContent file_content(const std::filesystem::path& path);

}  // namespace aftershade
