// Names of a Cryptomatte's objects, out of a file's header or of a file beside it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"

namespace aftershade {

struct ManifestEntry {
    std::string object;
    std::optional<std::uint32_t> id;  ///< nullopt where the manifest has none, or one that is none
};

/// The prefix of "/name", "/manifest" and "/manif_file" of each Cryptomatte that a header names:
/// "cryptomatte/3ae39a5".
std::vector<std::string> cryptomatte_keys(const ExrMetadata& metadata);

/// The names of the Cryptomatte under that key. Empty where its manifest is absent or damaged: it is only a
/// help. A manif_file lies in the folder of the EXR file; where that is a link, it may lie in that of its
/// target. Throws Error(ErrorKind::capture) where it is not a file that may be read.
std::vector<ManifestEntry> read_object_manifest(const std::filesystem::path& exr, const ExrMetadata& metadata,
                                                const std::string& key);

}  // namespace aftershade
