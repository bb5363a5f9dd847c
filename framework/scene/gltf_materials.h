// The materials of a glTF file; for the sources of this folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/scene/gltf_document.h"
#include "framework/scene/material.h"

namespace aftershade::scene {

/// Materials of a model that was loaded with its images; those that no triangle has stay unread. Throws as
/// read_gltf_model() does.
std::vector<Material> gltf_materials(const std::filesystem::path& path, const tinygltf::Model& model,
                                     std::vector<std::string>& warnings);

}  // namespace aftershade::scene
