// Reads an effect.json.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// The files of an effect that the host has translated from another program's file.
struct ForeignEffect {
    std::filesystem::path document;              ///< that file, in the effect's folder
    std::map<std::string, std::string> shaders;  ///< EffectManifest::generated
};

/// Parses and checks everything that can be known without GL: names, roles, ranges, that each pass reads only
/// what an earlier one may have written, that every output and texture is written, that shader files exist.
/// Every fault is reported; nullopt if there was one. check_declared_used (usage_check.h) compares
/// declarations with the shaders' text. Groups and loops are written out: the passes have the
/// conditions of their groups and textures, tile lists have their buffers and passes, and a pass that leaves
/// out `reads` or `writes` has those that its shaders' text names.
/// Modules and shared shaders are read from `glsl_folder`, empty for the shipped one; only then may this
/// throw, as data_path().
std::optional<EffectManifest> parse_manifest(const Node& node, const std::filesystem::path& folder,
                                             Diagnostics& diagnostics,
                                             const std::filesystem::path& glsl_folder = {},
                                             std::optional<ForeignEffect> foreign = std::nullopt);

}  // namespace aftershade
