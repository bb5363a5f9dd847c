// Materials, textures and tangents as finish.glsl reads them; for the sources of this folder.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/scene.h"

namespace aftershade::visibility {

struct GpuMaterial {
    glm::vec4 albedo{0};
    glm::vec4 albedo_2{0};
    glm::vec4 emission{0};
    glm::vec4 checker_cells{0};
    glm::uvec4 maps{0};
    glm::uvec4 normal_map{0};
};

struct GpuMaterials {
    std::vector<GpuMaterial> materials;
    /// For each texture its width, height, number of levels, how it repeats and what its texels stand for;
    /// then the texels of its levels as scene::SurfaceTexture::texels().
    std::vector<std::uint32_t> textures;
};

/// Throws Error(ErrorKind::usage) where the textures need more than `max_bytes`.
GpuMaterials gpu_materials(const scene::Scene& scene, std::size_t max_bytes);

/// The tangents of the corners of these triangles, each an object and its number among the object's; empty
/// where the scene has no normal map.
std::vector<glm::vec4> gpu_tangents(const scene::Scene& scene,
                                    std::span<const std::array<std::uint32_t, 2>> triangles);

}  // namespace aftershade::visibility
