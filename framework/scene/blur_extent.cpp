#include "framework/scene/blur_extent.h"

#include <algorithm>
#include <cmath>

namespace aftershade::scene {

using glm::dmat2;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

/// The share of the blur that counts.
constexpr double kOfBlur = 0.3;

/// Signed, + behind the focus; 0 where there is none to tell: behind the camera.
double coc_radius_px(const SceneRenderer& renderer, const CameraState& camera, const dvec3& world) {
    const double depth_m = -(camera.camera_from_world * dvec4(world, 1)).z;
    if (depth_m <= 0) return 0;
    return renderer.pixels_per_tangent(camera) * camera.aperture_radius_m *
           (1 / camera.focus_distance_m - 1 / depth_m);
}

/// The smallest of what is of one sign, else 0: somewhere between the corners it is 0.
double least(const std::array<double, 3>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low <= 0 && *high >= 0) return 0;
    return *low > 0 ? *low : -*high;
}

}  // namespace

dmat2 cells_from_px_of_blur(const SceneRenderer& renderer, const CameraState& camera,
                            const std::array<SceneState, 2>& ends, const glm::dmat4& world_from_object,
                            int object, const std::array<dvec3, 3>& corners) {
    std::array<double, 3> radii_px{};
    std::array<dvec2, 3> motions_px{};
    dvec2 sum_px(0);
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec4 corner(corners[i], 1);
        radii_px[i] = coc_radius_px(renderer, camera, dvec3(world_from_object * corner));
        std::array<dvec2, 2> at{};
        bool seen = true;
        for (std::size_t end = 0; end < 2; ++end)
            seen = renderer.project(ends[end].camera,
                                    ends[end].world_from_object[std::size_t(object)] * corner, at[end]) &&
                   seen;
        if (seen) motions_px[i] = at[1] - at[0];
        sum_px += motions_px[i];
    }
    const dvec2 along = glm::length(sum_px) > 0 ? glm::normalize(sum_px) : dvec2(1, 0);
    double motion_px = 1e9;
    for (const dvec2& motion : motions_px)
        motion_px = std::min(motion_px, std::max(glm::dot(motion, along), 0.0));
    const double radius_px = least(radii_px);
    const auto cell_px = [](double variance_px2) {
        return std::sqrt(1 + 12 * kOfBlur * kOfBlur * variance_px2);
    };
    const double disk_px2 = radius_px * radius_px / 4;
    const double length_px = cell_px(motion_px * motion_px / 12 + disk_px2), width_px = cell_px(disk_px2);
    const dvec2 across(-along.y, along.x);
    return glm::transpose(dmat2(along / length_px, across / width_px));
}

}  // namespace aftershade::scene
