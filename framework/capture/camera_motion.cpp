#include "framework/capture/camera_motion.h"

#include <cmath>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "framework/image/camera_matrix.h"

namespace aftershade {

namespace {

/// The point of view space at `depth_m` in front of the camera that projects to `ndc`; at +inf its direction,
/// w = 0. Row i of the projection, r_i, gives ndc_i (r_3 . p) = r_i . p: two equations in p.x and p.y.
glm::dvec4 view_point(const glm::dmat4& ndc_from_camera, glm::dvec2 ndc, double depth_m) {
    const glm::dmat4 rows = glm::transpose(ndc_from_camera);
    const glm::dvec4 a = rows[0] - ndc.x * rows[3], b = rows[1] - ndc.y * rows[3];
    const bool infinite = std::isinf(depth_m);
    const double z = infinite ? -1 : -depth_m, w = infinite ? 0 : 1;
    const double right_a = -(a.z * z + a.w * w), right_b = -(b.z * z + b.w * w);
    const double determinant = a.x * b.y - a.y * b.x;
    if (determinant == 0) return {0, 0, z, w};
    return {(right_a * b.y - a.y * right_b) / determinant, (a.x * right_b - right_a * b.x) / determinant, z,
            w};
}

}  // namespace

bool knows_motion(const Camera& current, const Camera& previous) {
    return current.camera_from_world && current.ndc_from_world && previous.ndc_from_world;
}

void fill_camera_velocity(Image& velocity, std::span<const std::size_t> pixels, const Image& depth,
                          const Window& grid, const Window& display, const Camera& current,
                          const Camera& previous) {
    const glm::dmat4 world_from_camera = glm::inverse(glm_matrix(*current.camera_from_world));
    const glm::dmat4 ndc_from_camera = glm_matrix(*current.ndc_from_world) * world_from_camera;
    const glm::dmat4 previous_ndc_from_camera = glm_matrix(*previous.ndc_from_world) * world_from_camera;
    const glm::dvec2 half_size(0.5 * display.width(), 0.5 * display.height());
    for (const std::size_t pixel : pixels) {
        const int x = int(pixel % std::size_t(grid.width())), y = int(pixel / std::size_t(grid.width()));
        const glm::dvec2 ndc((x + grid.min_x - display.min_x + 0.5) / half_size.x - 1,
                             1 - (y + grid.min_y - display.min_y + 0.5) / half_size.y);
        const glm::dvec4 before =
            previous_ndc_from_camera * view_point(ndc_from_camera, ndc, depth.at(x, y, 0));
        const bool in_front = before.w > 0;
        velocity.at(x, y, 0) = in_front ? float((ndc.x - before.x / before.w) * half_size.x) : 0.0f;
        velocity.at(x, y, 1) = in_front ? float((before.y / before.w - ndc.y) * half_size.y) : 0.0f;
    }
}

}  // namespace aftershade
