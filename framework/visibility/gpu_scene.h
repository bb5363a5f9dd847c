// A scene's triangles and lights as world.glsl reads them; for the sources of this folder.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/scene_renderer.h"
#include "framework/scene/shading_grid.h"

namespace aftershade::visibility {

template <class W = float>
glm::vec4 with(const glm::dvec3& xyz, W w = 0) {
    return {glm::vec3(xyz), float(w)};
}

struct GpuNode {
    glm::vec4 low_skip{0};
    glm::vec4 high_items{0};
};

struct GpuObject {
    std::uint32_t first_node = 0;
    std::uint32_t node_count = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t first_surface = 0;
    float opacity = 1;
    std::uint32_t flags = 0;  ///< 1: casts shadows, 2: has holes, 4: is mixed
    std::uint32_t unused[2] = {};
};

/// Where the shading samples of a triangle lie.
struct GpuGrid {
    std::array<glm::vec4, 3> view{};
    glm::vec4 cells_from_px{0};
    glm::vec4 grid{0};
};

/// A hierarchy for each mesh, in its own space. It is the same at all times.
struct GpuScene {
    std::vector<glm::vec4> meshes;  ///< two for each node, then three for each triangle, as leaves order them
    std::uint32_t triangles_at = 0;  ///< where they begin
    std::vector<GpuObject> objects;
};

/// Each triangle of each object: the object, and its number there.
std::vector<std::array<std::uint32_t, 2>> gpu_sources(const scene::Scene& scene);

/// Throws Error(ErrorKind::usage) for more than 2^20 triangles of all objects, and for meshes that reach
/// further than 1e9 m.
GpuScene make_gpu_scene(const scene::SceneRenderer& renderer);

/// The hierarchy over the objects as they stand at these moments. A leaf's item is an object. Throws
/// Error(ErrorKind::usage) for objects that reach further than 1e9 m.
std::vector<GpuNode> make_top(const scene::SceneRenderer& renderer, const std::vector<scene::World>& moments);

/// In the order of gpu_sources().
std::vector<GpuGrid> make_gpu_grids(const scene::Scene& scene, const scene::ShadingGrids& grids);

/// object_from_world of all objects at all moments, three rows each.
std::vector<glm::vec4> make_moments(const std::vector<scene::World>& moments);

/// Adds each light at one moment, as light.glsl has it.
inline constexpr std::size_t kLightRows = 6;
void add_lights(std::vector<glm::vec4>& rows, const scene::Scene& scene, const scene::SceneState& now);

}  // namespace aftershade::visibility
