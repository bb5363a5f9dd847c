#include "framework/effect/registry.h"
#include "framework/effect/isf/isf_effect.h"
#include "framework/effect/manifest/manifest_reader.h"

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <utility>

#include "framework/base/data_path.h"
#include "framework/base/text.h"
#include "framework/document/document.h"

namespace aftershade {

namespace fs = std::filesystem;

std::vector<fs::path> rooms_of_effects(const fs::path& folder) {
    return {folder, folder / "reference"};
}

EffectRegistry::EffectRegistry(const std::vector<fs::path>& folders, fs::path glsl_folder)
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
            add(effect.filename().string(), effect);
        } else if (is_isf_path(effect) && fs::is_regular_file(effect, unreadable)) {
            const std::string id = effect.stem().string();
            add(id, effect);
            isf_names_[snake_case(id)].push_back(effect);
        } else if (type == fs::file_type::none) unreadable_.emplace(effect, unreadable.message());
    }
    if (failure && failure != std::errc::no_such_file_or_directory)
        unreadable_.emplace(folder, failure.message());
}

void EffectRegistry::add(const std::string& id, const fs::path& effect) {
    if (!folders_.emplace(id, effect).second) hidden_.emplace_back(id, effect);
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
    auto found = folders_.find(id);
    const auto name = isf_names_.find(id);
    if (found == folders_.end() && name != isf_names_.end()) return &name->second.front();
    return found == folders_.end() ? nullptr : &found->second;
}

std::optional<fs::path> EffectRegistry::place_of(const std::string& id) const {
    if (const fs::path* known = folder(id)) return *known;
    std::error_code failure;
    if (is_isf_path(id) && fs::is_regular_file(id, failure)) return fs::path(id).lexically_normal();
    return std::nullopt;
}

bool EffectRegistry::contains(const std::string& id) const {
    return place_of(id).has_value();
}

bool EffectRegistry::is_isf(const std::string& id) const {
    const auto place = place_of(id);
    return place && is_isf_path(*place);
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

std::string EffectRegistry::namesake_of(const std::string& id, const fs::path& file) const {
    const auto files = isf_names_.find(id);
    if (files == isf_names_.end() || folders_.contains(id)) return "";
    for (const fs::path& other : files->second)
        if (other != file && other.parent_path() == file.parent_path()) return other.string();
    return "";
}

std::optional<EffectManifest> EffectRegistry::read(const fs::path& place, IsfSpace space,
                                                   Diagnostics& diagnostics) {
    if (is_isf_path(place)) return read_isf_manifest(place, space, glsl_folder_, diagnostics);
    const auto node = read_document(place / "effect.json", diagnostics);
    return node ? parse_manifest(*node, place, diagnostics, glsl_folder_) : std::nullopt;
}

const EffectManifest* EffectRegistry::find(const std::string& id, Diagnostics& diagnostics, IsfSpace space) {
    const auto place = place_of(id);
    if (!place) return nullptr;
    if (const std::string other = namesake_of(id, *place); !other.empty()) {
        add_once(diagnostics, {Severity::error,
                               {place->string()},
                               "'" + id + "' is the id of this file and of " + other +
                                   " (name the effect by the file's name or path, or rename one)"});
        return nullptr;
    }
    const Key key(place->string(), space);
    auto manifest = manifests_.find(key);
    if (manifest == manifests_.end()) {
        const std::size_t before = diagnostics.all().size();
        auto parsed = read(*place, space, diagnostics);
        if (!parsed)
            faults_[key].assign(diagnostics.all().begin() + std::ptrdiff_t(before), diagnostics.all().end());
        manifest = manifests_.emplace(key, std::move(parsed)).first;
    } else if (!manifest->second) {
        for (const Diagnostic& fault : faults_[key]) add_once(diagnostics, fault);
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
