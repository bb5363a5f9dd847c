// Reads scene.json.
#pragma once

#include <filesystem>
#include <optional>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/scene/scene.h"

namespace aftershade::scene {

/// Reads and checks scene.json and the meshes that it names, relative to its folder. nullopt after errors.
std::optional<Scene> read_scene(const std::filesystem::path& path, Diagnostics& diagnostics);
std::optional<Scene> parse_scene(const Node& node, Diagnostics& diagnostics);

}  // namespace aftershade::scene
