// Between a camera's matrices, row by row, and GLM's, column by column.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>

#include "framework/image/camera.h"

namespace aftershade {

inline glm::dmat4 glm_matrix(const CameraMatrix& rows) {
    glm::dmat4 matrix;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) matrix[column][row] = rows[std::size_t(row * 4 + column)];
    return matrix;
}

inline CameraMatrix camera_matrix(const glm::dmat4& matrix) {
    CameraMatrix rows{};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) rows[std::size_t(row * 4 + column)] = matrix[column][row];
    return rows;
}

}  // namespace aftershade
