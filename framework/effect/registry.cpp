#include "framework/effect/registry.h"
#include "framework/effect/manifest/manifest_reader.h"

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <utility>

#include "framework/base/data_path.h"
#include "framework/document/document.h"

namespace aftershade {

namespace fs = std::filesystem;

std::vector<fs::path> rooms_of_effects(const fs::path& folder) {
    return {folder, folder / "reference"};
}

EffectRegistry::EffectRegistry(std::vector<fs::path> folders, fs::path glsl_folder)
    : glsl_folder_(std::move(glsl_folder)) {
    for (const fs::path& folder : folders)
        for (const fs::path& room : rooms_of_effects(folder)) add_effects_in(room);
}

void EffectRegistry::add_effects_in(const fs::path& folder) {
    std::error_code failure;
    fs::directory_iterator at(folder, failure);
    for (const fs::directory_iterator end; !failure && at != end; at.increment(failure)) {
        std::error_code unreadable;
        const fs::path& effect = at->path();
        const fs::file_type type = fs::status(effect / "effect.json", unreadable).type();
        if (type == fs::file_type::regular) {
            const std::string id = effect.filename().string();
            if (!folders_.emplace(id, effect).second) hidden_.emplace_back(id, effect);
        } else if (type == fs::file_type::none) unreadable_.emplace(effect, unreadable.message());
    }
    if (failure && failure != std::errc::no_such_file_or_directory)
        unreadable_.emplace(folder, failure.message());
}

void EffectRegistry::warn_of_unreadable(Diagnostics& diagnostics) const {
    for (const auto& [folder, reason] : unreadable_)
        diagnostics.warning({folder.string()}, "cannot be read, and its effects are left out: " + reason);
}

void EffectRegistry::warn_of_hidden(Diagnostics& diagnostics) const {
    for (const auto& [id, folder] : hidden_) {
        const fs::path& used = folders_.at(id);
        std::error_code failure;
        if (fs::equivalent(used, folder, failure)) continue;
        diagnostics.warning({used.string()},
                            "hides the effect '" + id + "' of " + folder.string() + " (rename one of them)");
    }
}

const fs::path* EffectRegistry::folder(const std::string& id) const {
    const auto found = folders_.find(id);
    return found == folders_.end() ? nullptr : &found->second;
}

std::vector<std::string> EffectRegistry::ids() const {
    std::vector<std::string> ids;
    for (const auto& [id, folder] : folders_) ids.push_back(id);
    return ids;
}

namespace {

/// A look that uses a faulty effect twice says so once.
void add_once(Diagnostics& diagnostics, const Diagnostic& fault) {
    const auto is_same = [&](const Diagnostic& other) {
        return other.message == fault.message && to_string(other.place) == to_string(fault.place);
    };
    if (std::ranges::any_of(diagnostics.all(), is_same)) return;
    if (fault.severity == Severity::error) diagnostics.error(fault.place, fault.message);
    else diagnostics.warning(fault.place, fault.message);
}

}  // namespace

const EffectManifest* EffectRegistry::find(const std::string& id, Diagnostics& diagnostics) {
    const auto folder = folders_.find(id);
    if (folder == folders_.end()) return nullptr;
    auto manifest = manifests_.find(id);
    if (manifest == manifests_.end()) {
        const std::size_t before = diagnostics.all().size();
        const auto node = read_document(folder->second / "effect.json", diagnostics);
        auto parsed = node ? parse_manifest(*node, folder->second, diagnostics, glsl_folder_) : std::nullopt;
        if (!parsed)
            faults_[id].assign(diagnostics.all().begin() + std::ptrdiff_t(before), diagnostics.all().end());
        manifest = manifests_.emplace(id, std::move(parsed)).first;
    } else if (!manifest->second) {
        for (const Diagnostic& fault : faults_[id]) add_once(diagnostics, fault);
    }
    return manifest->second ? &*manifest->second : nullptr;
}

bool is_shipped(const EffectManifest& manifest) {
    return is_shipped(manifest.folder);
}

bool is_shipped(const fs::path& effect_folder) {
    std::error_code failure;
    const fs::path shipped = fs::weakly_canonical(data_path() / "effects", failure);
    if (failure) return false;
    const fs::path room = fs::weakly_canonical(effect_folder, failure).parent_path();
    return !failure && std::ranges::count(rooms_of_effects(shipped), room) > 0;
}

}  // namespace aftershade
