// Cameras for tests, out of where they stand and look.
#pragma once

#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "framework/image/camera_matrix.h"

namespace aftershade::test {

struct CameraPose {
    glm::dvec3 position_m{0};
    glm::dvec3 angles_deg{0};  ///< about the view's x, then y, then z: tilt up, pan left, roll
    double focal_length_mm = 36;
    double sensor_width_mm = 36;

    glm::dmat4 world_from_view() const {
        glm::dmat4 matrix = glm::translate(glm::dmat4(1), position_m);
        matrix = glm::rotate(matrix, glm::radians(angles_deg.y), glm::dvec3(0, 1, 0));
        matrix = glm::rotate(matrix, glm::radians(angles_deg.x), glm::dvec3(1, 0, 0));
        return glm::rotate(matrix, glm::radians(angles_deg.z), glm::dvec3(0, 0, 1));
    }

    /// px on the picture for a tangent of 1.
    double focal_px(int width) const { return width * focal_length_mm / sensor_width_mm; }

    /// Where the picture shows a point of the world, px, +y down; w = 0 is a direction. Behind the camera it
    /// means nothing.
    glm::dvec2 pixel_of(glm::dvec4 world, int width, int height) const {
        const glm::dvec4 view = glm::inverse(world_from_view()) * world;
        return glm::dvec2(width, height) * 0.5 + glm::dvec2(view.x, -view.y) / -view.z * focal_px(width);
    }

    /// The point of the world that a place of the picture shows at a depth; at infinity its direction, w = 0.
    glm::dvec4 world_at(glm::dvec2 pixel, double depth_m, int width, int height) const {
        const glm::dvec2 tangent = (pixel - glm::dvec2(width, height) * 0.5) / focal_px(width);
        const bool far = std::isinf(depth_m);
        const glm::dvec3 view = glm::dvec3(tangent.x, -tangent.y, -1) * (far ? 1.0 : depth_m);
        return world_from_view() * glm::dvec4(view, far ? 0 : 1);
    }
};

/// Writes the matrices that a capture of `width` x `height` px would have.
inline void set_pose(Camera& camera, const CameraPose& pose, int width, int height) {
    const double scale = 2 * pose.focal_length_mm / pose.sensor_width_mm;
    glm::dmat4 ndc(0.0);
    ndc[0][0] = scale;
    ndc[1][1] = scale * width / height;
    ndc[2][2] = ndc[2][3] = -1;
    ndc[3][2] = -0.01;
    const glm::dmat4 view_from_world = glm::inverse(pose.world_from_view());
    camera.camera_from_world = camera_matrix(view_from_world);
    camera.ndc_from_world = camera_matrix(ndc * view_from_world);
}

}  // namespace aftershade::test
