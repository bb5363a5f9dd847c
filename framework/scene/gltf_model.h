// Triangles with the materials that their file gives them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/scene/material.h"
#include "framework/scene/mesh.h"

namespace aftershade::scene {

struct GltfModel {
    Mesh mesh;  ///< Mesh::materials are indices into `materials`
    std::vector<Material> materials;
    std::vector<std::string> warnings;  ///< what the file lacks for its materials; each begins with the path
};

/// As read_gltf(), with materials: metallic and roughness, alpha, and textures from PNG and JPEG, 16 bits as
/// 8, by any set of texture coordinates and KHR_texture_transform. Triangles with a normal map have tangents,
/// the file's or those of make_tangents(). Throws Error(ErrorKind::usage) that begins with the path, also for
/// an image that is not there, damaged or not in the file's folder, and for more than 2^27 texels.
GltfModel read_gltf_model(const std::filesystem::path& path);

}  // namespace aftershade::scene
