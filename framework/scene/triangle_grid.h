// The grid of shading samples of one triangle, and whether that of an earlier frame still serves.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "framework/scene/scene_renderer.h"

namespace aftershade::scene {

/// Cells over the picture of a pinhole camera.
struct TriangleGrid {
    glm::dmat2 cells_from_px{1};
    glm::dvec2 low{0};  ///< of the grid, in cells
    glm::ivec2 size{1};
    std::uint32_t start = 0;   ///< the first id over 2
    std::uint32_t camera = 0;  ///< whose picture it is: index into a frame's cameras, of which its own is 0
};

/// The grids of a frame.
struct FrameGrids {
    int frame = 0;
    std::vector<TriangleGrid> grids;  ///< of each triangle of each object, in their order
    std::vector<CameraState> cameras;
};

/// A kept cell is at most this many times as long as the frame's own would be, where the picture shows it.
inline constexpr double kMostStretch = 1.01;
/// Where a grid no longer serves, the next one has this many times as many cells along x and y, to serve
/// longer.
inline constexpr double kFiner = 1.5;
/// A grid is dropped if its cells have less than this share of the area of the frame's own everywhere.
inline constexpr double kLeastArea = 0.4;

class KeptGrids {
public:
    /// `now` is the frame's own moment. All of these must outlive this.
    KeptGrids(const SceneRenderer& renderer, const SceneState& now, const FrameGrids& earlier);

    bool has_moved(int object) const;
    /// The earlier grid of triangle `index` of the scene, unless that no longer serves. `own` is the frame's,
    /// and `wanted` its cells from px before they fill the triangle's bounds. Adds the kept grid's camera to
    /// `cameras`.
    std::optional<TriangleGrid> kept(const TriangleGrid& own, std::size_t index, int object,
                                     const std::array<glm::dvec3, 3>& corners, const glm::dmat2& wanted,
                                     std::vector<CameraState>& cameras);

private:
    bool serves(const TriangleGrid& earlier, const TriangleGrid& own, const std::array<glm::dvec3, 3>& world,
                const glm::dmat2& wanted) const;
    glm::dmat2 px_from_plane(const CameraState& camera, const glm::dvec3& point,
                             const std::array<glm::dvec3, 2>& sides) const;

    const SceneRenderer& renderer_;
    const SceneState& now_;
    const FrameGrids& earlier_;
    SceneState then_;
    std::unordered_map<std::uint32_t, std::uint32_t> cameras_;  ///< of the earlier ones, by their index there
};

}  // namespace aftershade::scene
