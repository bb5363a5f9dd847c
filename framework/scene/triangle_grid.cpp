#include "framework/scene/triangle_grid.h"

#include <algorithm>
#include <cmath>

#include "framework/scene/scene_state.h"

namespace aftershade::scene {

using glm::dmat2;
using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

/// Around the picture, over its width: lens and shutter show some of what lies there.
constexpr double kBeyondPicture = 0.05;
constexpr double kBeforeCamera_m = 1e-3;

/// The part of a polygon where height(point) is at least 0 (Sutherland and Hodgman 1974).
template <class Height>
std::vector<dvec3> cut(const std::vector<dvec3>& polygon, const Height& height) {
    std::vector<dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double height_a = height(a), height_b = height(b);
        if (height_a >= 0) kept.push_back(a);
        if ((height_a >= 0) != (height_b >= 0))
            kept.push_back(glm::mix(a, b, height_a / (height_a - height_b)));
    }
    return kept;
}

/// The part of a triangle that the picture of a pinhole camera shows, in world space.
std::vector<dvec3> shown_part(const SceneRenderer& renderer, const CameraState& camera,
                              const std::array<dvec3, 3>& world) {
    const dvec2 picture_px(renderer.width_px(), renderer.height_px());
    const dvec2 tangent =
        (0.5 * picture_px + kBeyondPicture * picture_px.x) / renderer.pixels_per_tangent(camera);
    std::vector<dvec3> view;
    for (const dvec3& corner : world) view.emplace_back(camera.camera_from_world * dvec4(corner, 1));
    view = cut(view, [](const dvec3& p) { return -p.z - kBeforeCamera_m; });
    for (const double sign : {-1.0, 1.0}) {
        view = cut(view, [&](const dvec3& p) { return -p.z * tangent.x + sign * p.x; });
        view = cut(view, [&](const dvec3& p) { return -p.z * tangent.y + sign * p.y; });
    }
    for (dvec3& point : view) point = dvec3(camera.world_from_camera * dvec4(point, 1));
    return view;
}

/// How far the step of length 1 goes that goes least: the smaller singular value.
double shortest_step(const dmat2& m) {
    const double det = std::abs(glm::determinant(m));
    const double sum = glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]);
    return det / std::sqrt(0.5 * (sum + std::sqrt(std::max(sum * sum - 4 * det * det, 0.0))));
}

}  // namespace

KeptGrids::KeptGrids(const SceneRenderer& renderer, const SceneState& now, const FrameGrids& earlier)
    : renderer_(renderer),
      now_(now),
      earlier_(earlier),
      then_(state_at(renderer.scene(), earlier.frame, earlier.frame)) {}

bool KeptGrids::has_moved(int object) const {
    return then_.world_from_object[std::size_t(object)] != now_.world_from_object[std::size_t(object)];
}

std::optional<TriangleGrid> KeptGrids::kept(const TriangleGrid& own, std::size_t index, int object,
                                            const std::array<dvec3, 3>& corners, const dmat2& wanted,
                                            std::vector<CameraState>& cameras) {
    const glm::dmat4& world_from_object = now_.world_from_object[std::size_t(object)];
    std::array<dvec3, 3> world;
    for (std::size_t i = 0; i < 3; ++i) world[i] = dvec3(world_from_object * dvec4(corners[i], 1));
    TriangleGrid grid = earlier_.grids[index];
    if (has_moved(object) || !serves(grid, own, world, wanted)) return std::nullopt;
    const auto [at, is_new] = cameras_.try_emplace(grid.camera, std::uint32_t(cameras.size()));
    if (is_new) cameras.push_back(earlier_.cameras[grid.camera]);
    grid.camera = at->second;
    return grid;
}

/// The derivative of a picture's px by steps along two sides of a plane.
dmat2 KeptGrids::px_from_plane(const CameraState& camera, const dvec3& point,
                               const std::array<dvec3, 2>& sides) const {
    const dvec3 view(camera.camera_from_world * dvec4(point, 1));
    dmat2 px;
    for (int i = 0; i < 2; ++i) {
        const dvec3 step = dmat3(camera.camera_from_world) * sides[std::size_t(i)];
        px[i] = renderer_.pixels_per_tangent(camera) / (view.z * view.z) *
                dvec2(view.x * step.z - view.z * step.x, view.z * step.y - view.y * step.z);
    }
    return px;
}

bool KeptGrids::serves(const TriangleGrid& earlier, const TriangleGrid& own,
                       const std::array<dvec3, 3>& world, const dmat2& wanted) const {
    const CameraState& then = earlier_.cameras[earlier.camera];
    const dvec3 normal = glm::normalize(glm::cross(world[1] - world[0], world[2] - world[0]));
    const dvec3 along = glm::normalize(world[1] - world[0]);
    const std::array<dvec3, 2> sides = {along, glm::cross(normal, along)};
    const dvec2 picture_px(renderer_.width_px(), renderer_.height_px());
    const std::vector<dvec3> shown = shown_part(renderer_, now_.camera, world);
    double largest_area = 0;
    for (const dvec3& point : shown) {
        dvec2 px;
        // Beyond that all is the border of the grid.
        if (!renderer_.project(then, dvec4(point, 1), px) ||
            glm::clamp(px, -picture_px, 2.0 * picture_px) != px)
            return false;
        const dmat2 cells_from_px = earlier.cells_from_px * px_from_plane(then, point, sides) *
                                    glm::inverse(px_from_plane(now_.camera, point, sides));
        // Not a number where the camera looks along the triangle.
        if (!(kMostStretch * shortest_step(cells_from_px * glm::inverse(wanted)) >= 1)) return false;
        largest_area = std::max(
            largest_area, std::abs(glm::determinant(own.cells_from_px) / glm::determinant(cells_from_px)));
    }
    return shown.empty() || largest_area >= kLeastArea;
}

}  // namespace aftershade::scene
