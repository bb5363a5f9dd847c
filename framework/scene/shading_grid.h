// Shading samples: numbers for the places of a scene's triangles where light is computed once for all the
// visibility samples that meet them (Ragan-Kelley et al. 2011, Decoupled Sampling for Graphics Pipelines).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/scene_renderer.h"
#include "framework/scene/triangle_grid.h"

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
/// frame's own time, or at that of an earlier frame whose grid still serves. Ids are the prefix sum over the
/// triangles' cells, twice: the two sides of a triangle have ids of their own. Beyond one picture's width and
/// height outside the picture all is the grid's border. [const functions: any thread]
class ShadingGrids {
public:
    /// `renderer` is of a scene of meshes (triangulated()) and must outlive this. Triangles that have not
    /// moved keep their earlier grid while it serves (KeptGrids). Throws Error(ErrorKind::usage) where
    /// kMaxShadingIds are not enough.
    ShadingGrids(const SceneRenderer& renderer, int frame, const ShadingGridSettings& settings,
                 const FrameGrids* earlier = nullptr);

    std::uint32_t id_count() const { return id_count_; }
    /// The id of a point that a ray hit, at any time.
    std::uint32_t id_of(const Surface& surface) const;
    /// The cell's centre, drawn into the triangle.
    ShadingPlace place_of(std::uint32_t id) const;
    /// Which triangle of the whole scene an id belongs to.
    std::uint32_t triangle_of(std::uint32_t id) const;
    /// Light at the cell's centre, with the mean albedo of kAlbedoPoints x kAlbedoPoints places of the cell.
    /// `seen` is that of World::shade().
    Shading shading(std::uint32_t id, std::span<double> seen = {}) const;
    glm::dvec3 shade(std::uint32_t id) const { return shading(id).color(); }
    static constexpr int kAlbedoPoints = 4;
    /// Where that light is computed, with the random rays of the cell that had the id `ray_id`.
    Surface surface_of(std::uint32_t id, std::uint32_t ray_id) const;
    const World& world() const { return world_; }

    const std::vector<TriangleGrid>& grids() const { return of_frame_.grids; }
    const FrameGrids& of_frame() const { return of_frame_; }
    const SceneState& reference() const { return world_.state(); }

private:
    TriangleGrid grid_of(int object, const std::array<glm::dvec3, 3>& corners,
                         const glm::dmat2& cells_from_px, GridOrigin origin) const;
    glm::dvec2 reference_px(const glm::dvec3& world, const CameraState& camera) const;
    const Mesh& mesh_of(int object) const;
    /// The ray through `part` of a cell, 0 to 1 along x and y, in the object's space.
    Ray ray_through(int object, std::uint32_t triangle, std::uint32_t id, const glm::dvec2& part) const;
    /// Where that ray meets the triangle's plane, which may be outside the triangle.
    glm::dvec2 weights_through(const ShadingPlace& place, std::uint32_t id, const glm::dvec2& part) const;
    /// The sides of a cell in a triangle's weights.
    glm::dmat2 weights_of_cell(const ShadingPlace& place, std::uint32_t id) const;
    glm::dvec3 mean_albedo(const Surface& middle, std::uint32_t id, const Material& material) const;

    const SceneRenderer& renderer_;
    World world_;                                ///< at the frame's own time
    std::vector<std::uint32_t> first_triangle_;  ///< of each object
    FrameGrids of_frame_;
    std::uint32_t id_count_ = 0;
};

}  // namespace aftershade::scene
