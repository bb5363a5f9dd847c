// An ISF file as an effect of ours: the manifest and the shaders that a folder of it would hold.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/effect/isf/isf_types.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

struct IsfEffect {
    Node manifest;                               ///< the content of an effect.json, with places in the file
    std::map<std::string, std::string> shaders;  ///< by name of their file
};

/// `file` has no faults.
IsfEffect effect_of_isf(const IsfFile& file, const std::string& id, IsfSpace space);

/// Reads the file; its id is its name in snake_case. nullopt after faults.
std::optional<EffectManifest> read_isf_manifest(const std::filesystem::path& path, IsfSpace space,
                                                const std::filesystem::path& glsl_folder,
                                                Diagnostics& diagnostics);

/// Makes the folder of an effect from the file, with copies of all that it needs, and returns their paths;
/// the effect's id is the folder's name. Empty after faults. Throws Error(ErrorKind::output).
std::vector<std::filesystem::path> import_isf(const std::filesystem::path& path,
                                              const std::filesystem::path& folder, IsfSpace space,
                                              Diagnostics& diagnostics);

}  // namespace aftershade
