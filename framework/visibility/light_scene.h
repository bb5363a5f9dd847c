// A scene at the frame's own time as shade.comp reads it, and the lights and materials of light_samples.comp;
// for the sources of this folder.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/scene_renderer.h"
#include "framework/scene/shading_grid.h"
#include "framework/visibility/gpu_scene.h"
#include "framework/visibility/gpu_textures.h"

namespace aftershade::visibility {

/// A triangle that casts a shadow.
struct GpuBlocker {
    glm::vec4 corner{0};
    glm::vec4 to_second{0};
    glm::vec4 to_third{0};
};

/// A triangle that light falls on, and its grid of shading samples.
struct GpuSurface {
    glm::vec4 corner{0};
    glm::vec4 to_second{0};
    glm::vec4 to_third{0};
    std::array<glm::vec4, 3> normals{};
    glm::vec4 px_from_cells{0};
    glm::vec4 grid{0};
};

struct GpuLight {
    glm::vec4 position{0};
    glm::vec4 direction{0};
    glm::vec4 half_u{0};
    glm::vec4 half_v{0};
    glm::vec4 intensity{0};
    glm::vec4 axis{0};
};

struct LightScene {
    std::vector<GpuNode> nodes;
    std::vector<GpuBlocker> blockers;   ///< as the leaves order them
    std::vector<std::uint32_t> starts;  ///< as scene::ShadingGrids::grids()
    std::vector<GpuSurface> surfaces;   ///< the same
    GpuMaterials materials;
    std::vector<glm::vec4> tangents;  ///< of the surfaces, as gpu_tangents() has them, in the world
    std::vector<GpuLight> lights;
};

std::vector<GpuLight> gpu_lights(const scene::Scene& scene, const scene::SceneState& now);

/// Throws Error(ErrorKind::usage) for more than 2^20 triangles, and for textures of more than `max_bytes`.
LightScene make_light_scene(const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids,
                            std::size_t max_bytes);

}  // namespace aftershade::visibility
