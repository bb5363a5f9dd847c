// Objects, materials, textures and what triangles have beside their corners, as world.glsl reads them; for
// the sources of this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/scene_renderer.h"
#include "framework/visibility/gpu_scene.h"

namespace aftershade::visibility {

struct GpuLooks {
    /// Objects, materials and textures. A texture is its width, height, number of levels, how it repeats and
    /// what its texels stand for; then the texels of its levels as scene::SurfaceTexture::texels().
    std::vector<std::uint32_t> words;
    std::uint32_t materials_at = 0;
};

/// Without `light`, textures are those alone that decide about opacity. Throws Error(ErrorKind::usage) where
/// all need more than `max_bytes`.
GpuLooks gpu_looks(const scene::Scene& scene, std::span<const GpuObject> objects, bool light,
                   std::size_t max_bytes);

/// Of each triangle of each object, in the order of gpu_sources(): the tangents of its corners, if there is
/// light and any material has a normal map; then the corners' texture coordinates in each channel, if there
/// are several or opacity needs them.
struct GpuExtras {
    std::vector<glm::vec4> values;
    std::uint32_t stride = 0;
    std::uint32_t uvs_at = 0;
};

/// Tangents are in the world of `world`, or in the objects' spaces if it is null. Throws
/// Error(ErrorKind::usage) for more than `max_bytes`.
GpuExtras gpu_extras(const scene::SceneRenderer& renderer, bool light, const scene::SceneState* world,
                     std::size_t max_bytes);

}  // namespace aftershade::visibility
