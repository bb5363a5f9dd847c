// Reads a file of the Interactive Shader Format.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "framework/base/diagnostics.h"
#include "framework/effect/isf/isf_types.h"

namespace aftershade {

/// ISF 2 and 1. Faults have their line in the file; nullopt if there was one. What ISF does not know is left
/// out, as its hosts do.
std::optional<IsfFile> read_isf(const std::filesystem::path& path, Diagnostics& diagnostics);
/// The same of texts in memory.
std::optional<IsfFile> parse_isf(const std::filesystem::path& path, std::string text,
                                 Diagnostics& diagnostics);

}  // namespace aftershade
