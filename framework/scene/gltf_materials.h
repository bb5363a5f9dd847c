// The materials of a glTF file; for the sources of this folder.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "framework/scene/gltf_document.h"
#include "framework/scene/material.h"

namespace aftershade::scene {

/// Texture coordinates as a texture needs them: those of a set of the file, and KHR_texture_transform.
struct UvChannel {
    int set = 0;
    glm::dmat3x2 from_set{1, 0, 0, 1, 0, 0};
    bool operator==(const UvChannel&) const = default;
};

struct GltfMaterials {
    std::vector<Material> materials;
    std::vector<std::vector<UvChannel>> channels;  ///< of each material, from channel 1 on
};

/// Materials of a model that was loaded with its images; those that no triangle has stay unread. Throws as
/// read_gltf_model() does.
GltfMaterials gltf_materials(const std::filesystem::path& path, const tinygltf::Model& model);

}  // namespace aftershade::scene
