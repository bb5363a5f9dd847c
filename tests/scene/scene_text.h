// Scenes out of text and out of scenes/, for the tests of this folder.
#pragma once

#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/scene/scene_reader.h"

namespace aftershade::scene {

inline std::string faults_of(const Diagnostics& diagnostics) {
    std::ostringstream text;
    diagnostics.print(text);
    return text.str();
}

/// Throws with all faults.
inline Scene scene_of(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, "scene.json", diagnostics);
    auto scene = node ? parse_scene(*node, diagnostics) : std::nullopt;
    if (!scene) throw std::runtime_error(faults_of(diagnostics));
    return std::move(*scene);
}

inline std::filesystem::path scenes_folder() {
    return std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "scenes";
}

/// The ids of the shipped scenes, sorted.
inline std::vector<std::string> shipped_scenes() {
    std::vector<std::string> ids;
    for (const auto& entry : std::filesystem::directory_iterator(scenes_folder()))
        if (std::filesystem::exists(entry.path() / "scene.json"))
            ids.push_back(entry.path().filename().string());
    std::sort(ids.begin(), ids.end());
    return ids;
}

inline Scene shipped_scene(const std::string& id) {
    Diagnostics diagnostics;
    auto scene = read_scene(scenes_folder() / id / "scene.json", diagnostics);
    if (!scene) throw std::runtime_error(faults_of(diagnostics));
    return std::move(*scene);
}

}  // namespace aftershade::scene
