// Shading samples: numbers for the places of a scene's triangles where light is computed once for all the
// visibility samples that meet them (Ragan-Kelley et al. 2011, Decoupled Sampling for Graphics Pipelines).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/scene_renderer.h"

namespace aftershade::scene {

/// A set of these in bits fills 128 MiB, the largest storage block of some GL drivers.
inline constexpr std::uint32_t kMaxShadingIds = 1u << 30;
/// Where nothing was met.
inline constexpr std::uint32_t kNoShading = 0xffffffff;

enum class GridOrigin {
    triangle,  ///< a corner of its bounds, whose width and height are whole cells: few cells half outside
    picture    ///< the picture's, as in Liktor and Dachsbacher 2013, Decoupled Deferred Shading on the GPU
};

struct ShadingGridSettings {
    GridOrigin origin = GridOrigin::triangle;
    double rate = 1;           ///< cells of the grid for each px, along x and y; from a triangle at least
    bool anisotropic = false;  ///< cells as long and as wide as the blur allows (Vaidyanathan et al. 2012)
};

/// The cell of a shading sample.
struct ShadingPlace {
    int object = 0;
    std::uint32_t triangle = 0;
    glm::dvec2 barycentric{0};  ///< weights of the second and third corner; inside the triangle
    bool from_behind = false;
};

/// Each triangle has a grid over its bounds as the reference pose shows them: the pinhole camera at the
/// frame's own time. Ids are the prefix sum over the triangles' cells, twice: the two sides of a triangle
/// have ids of their own. Beyond one picture's width and height outside the picture all is the grid's border.
/// [const functions: any thread]
class ShadingGrids {
public:
    /// `renderer` is of a scene of meshes (triangulated()) and must outlive this. Throws
    /// Error(ErrorKind::usage) where kMaxShadingIds are not enough.
    ShadingGrids(const SceneRenderer& renderer, int frame, const ShadingGridSettings& settings);

    std::uint32_t id_count() const { return id_count_; }
    /// The id of a point that a ray hit, at any time.
    std::uint32_t id_of(const Surface& surface) const;
    /// The cell's centre, drawn into the triangle.
    ShadingPlace place_of(std::uint32_t id) const;
    /// Which triangle of the whole scene an id belongs to.
    std::uint32_t triangle_of(std::uint32_t id) const;
    /// Light at the cell's centre, with the mean albedo of kAlbedoPoints x kAlbedoPoints places of the cell.
    glm::dvec3 shade(std::uint32_t id) const;
    static constexpr int kAlbedoPoints = 4;

    /// The grid of one triangle.
    struct Grid {
        glm::dmat2 cells_from_px{1};
        glm::dvec2 low{0};  ///< of the grid, in cells
        glm::ivec2 size{1};
        std::uint32_t start = 0;  ///< the first id over 2
    };
    /// The grid of each triangle of each object, in their order.
    const std::vector<Grid>& grids() const { return grids_; }
    const SceneState& reference() const { return world_.state(); }

private:
    Grid grid_of(int object, const Mesh& mesh, std::uint32_t triangle, const ShadingGridSettings& settings,
                 const std::array<SceneState, 2>& ends) const;
    glm::dvec2 reference_px(const glm::dvec3& world) const;
    const Mesh& mesh_of(int object) const;
    /// The ray through `part` of a cell, 0 to 1 along x and y, in the object's space.
    Ray ray_through(const ShadingPlace& place, std::uint32_t id, const glm::dvec2& part) const;
    glm::dvec2 uv_through(const ShadingPlace& place, std::uint32_t id, const glm::dvec2& part) const;
    /// The sides of a cell in texture coordinates.
    glm::dmat2 uv_of_cell(const ShadingPlace& place, std::uint32_t id) const;
    glm::dvec3 mean_albedo(const ShadingPlace& place, std::uint32_t id, const Material& material,
                           const glm::dmat2& uv_of_cell) const;

    const SceneRenderer& renderer_;
    World world_;                                ///< at the frame's own time
    std::vector<std::uint32_t> first_triangle_;  ///< of each object
    std::vector<Grid> grids_;
    std::uint32_t id_count_ = 0;
};

}  // namespace aftershade::scene
