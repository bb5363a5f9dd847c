// The files that a new effect begins with.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace aftershade {

/// Makes <folder>/<id>/ with a manifest, a shader and a look, whole or not at all, and returns the files with
/// their numbers of lines. `id` is in snake_case. Throws Error(ErrorKind::output), also where something has
/// that path.
std::vector<std::pair<std::filesystem::path, int>> make_effect(const std::filesystem::path& folder,
                                                               const std::string& id);

}  // namespace aftershade
