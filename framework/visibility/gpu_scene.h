// A scene's triangles over an exposure as trace.comp reads them; for the sources of this folder.
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

struct GpuTriangle {
    glm::vec4 corner{0};
    glm::vec4 to_second{0};
    glm::vec4 to_third{0};
    std::array<glm::vec4, 3> view{};
    glm::vec4 cells_from_px{0};
    glm::vec4 grid{0};
};

struct GpuScene {
    std::vector<GpuNode> nodes;
    std::vector<GpuTriangle> triangles;  ///< as the leaves order them
    /// The object of each, and its number among the object's triangles.
    std::vector<std::array<std::uint32_t, 2>> sources;
};

/// The items of a leaf have three bits of their word in bvh.glsl, their index 29.
inline constexpr int kLeafSize = 4;
std::vector<GpuNode> gpu_nodes(const scene::Bvh& bvh);

/// Throws Error(ErrorKind::usage) for more than 2^20.
void check_triangle_count(const scene::Scene& scene, const scene::ShadingGrids& grids);

/// One hierarchy over all triangles, whose boxes hold them over the whole exposure of `frame`.
GpuScene make_gpu_scene(const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids, int frame);

/// object_from_world of all objects at all moments, three rows each.
std::vector<glm::vec4> make_moments(const std::vector<scene::World>& moments);

}  // namespace aftershade::visibility
