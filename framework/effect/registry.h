// Finds effects on disk. Nothing outside an effect's folder names the effect.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/effect/isf/isf_types.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// Where effects lie in a folder of them: in it, and in its folder `reference`, which has those that others
/// are measured by.
std::vector<std::filesystem::path> rooms_of_effects(const std::filesystem::path& folder);

/// Folders of effects, searched in order; each effect is a folder <id>/ with an effect.json, or an ISF file,
/// whose id is its name without ".fs" or that in snake_case, unless two files of one folder have that. The
/// path of an ISF file is an id, too. [one thread at a time: manifests are read when they are first asked
/// for]
class EffectRegistry {
public:
    /// Modules are read from `glsl_folder`, empty for the shipped one.
    explicit EffectRegistry(const std::vector<std::filesystem::path>& folders,
                            std::filesystem::path glsl_folder = {});

    /// Ids of all effects, sorted. The first folder wins where two have an effect of one id.
    std::vector<std::string> ids() const;
    bool contains(const std::string& id) const;
    /// The effect's folder, or the ISF file itself; nullptr for an unknown effect.
    const std::filesystem::path* folder(const std::string& id) const;
    /// A warning for each folder that could not be read; what it holds is left out.
    void warn_of_unreadable(Diagnostics& diagnostics) const;
    /// A warning for each effect that has the id of one in a later folder, which it hides.
    void warn_of_hidden(Diagnostics& diagnostics) const;
    /// nullptr after faults in the manifest, each of which `diagnostics` gets once, however often it is
    /// sought.
    const EffectManifest* find(const std::string& id, Diagnostics& diagnostics,
                               IsfSpace space = IsfSpace::display);
    /// Whether the effect is an ISF file, which alone has a space.
    bool is_isf(const std::string& id) const;

private:
    void add_effects_in(const std::filesystem::path& folder);
    void add(const std::string& id, const std::filesystem::path& effect);
    std::optional<std::filesystem::path> place_of(const std::string& id) const;
    /// Another ISF file of the folder with the same snake_case, by which `id` names them; "": none.
    std::string namesake_of(const std::string& id, const std::filesystem::path& file) const;
    std::optional<EffectManifest> read(const std::filesystem::path& place, IsfSpace space,
                                       Diagnostics& diagnostics);

    std::filesystem::path glsl_folder_;
    std::map<std::string, std::filesystem::path> folders_;                 // by id; of ISF the files
    std::map<std::string, std::vector<std::filesystem::path>> isf_names_;  // ISF files by their snake_case
    std::map<std::filesystem::path, std::string> unreadable_;              // reasons
    std::vector<std::pair<std::string, std::filesystem::path>> hidden_;    // ids and folders
    using Key = std::pair<std::string, IsfSpace>;
    std::map<Key, std::optional<EffectManifest>> manifests_;
    std::map<Key, std::vector<Diagnostic>> faults_;  // of the manifests that are nullopt
};

/// Whether the effect is one of those that come with the program; all others are untrusted. Throws as
/// data_path() does.
bool is_shipped(const EffectManifest& manifest);
bool is_shipped(const std::filesystem::path& effect_folder);

}  // namespace aftershade
