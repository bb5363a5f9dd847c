#include "framework/effect/registry.h"

#include <utility>

#include "framework/core/data_path.h"
#include "framework/core/document.h"

namespace aftershade {

namespace fs = std::filesystem;

EffectRegistry::EffectRegistry(std::vector<fs::path> folders, fs::path glsl_folder)
    : glsl_folder_(std::move(glsl_folder)) {
    for (const fs::path& folder : folders) {
        std::error_code failure;
        for (const auto& entry : fs::directory_iterator(folder, failure))
            if (fs::is_regular_file(entry.path() / "effect.json"))
                folders_.emplace(entry.path().filename().string(), entry.path());
    }
}

std::vector<std::string> EffectRegistry::ids() const {
    std::vector<std::string> ids;
    for (const auto& [id, folder] : folders_) ids.push_back(id);
    return ids;
}

const EffectManifest* EffectRegistry::find(const std::string& id, Diagnostics& diagnostics) {
    const auto folder = folders_.find(id);
    if (folder == folders_.end()) return nullptr;
    auto manifest = manifests_.find(id);
    if (manifest == manifests_.end()) {
        const auto node = read_document(folder->second / "effect.json", diagnostics);
        auto parsed = node ? parse_manifest(*node, folder->second, diagnostics, glsl_folder_) : std::nullopt;
        manifest = manifests_.emplace(id, std::move(parsed)).first;
    }
    return manifest->second ? &*manifest->second : nullptr;
}

bool is_shipped(const EffectManifest& manifest) {
    std::error_code failure;
    const fs::path shipped = fs::weakly_canonical(data_path() / "effects", failure);
    return !failure && fs::weakly_canonical(manifest.folder, failure).parent_path() == shipped && !failure;
}

}  // namespace aftershade
