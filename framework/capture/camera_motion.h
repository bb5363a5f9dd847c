// Motion of what does not move itself: the camera's alone.
#pragma once

#include <cstddef>
#include <span>

#include "framework/image/camera.h"
#include "framework/image/image.h"

namespace aftershade {

/// Both matrices of both cameras are known.
bool knows_motion(const Camera& current, const Camera& previous);

/// Writes, at each of `pixels` (row-major indices of the grid), the current minus the previous position in
/// px, +y down, of the static point that the pixel shows. `depth` has the grid's size, in m; at +inf only the
/// camera's turning counts. knows_motion() must hold. A point that the previous camera did not have in front
/// of it gets 0.
void fill_camera_velocity(Image& velocity, std::span<const std::size_t> pixels, const Image& depth,
                          const Window& grid, const Window& display, const Camera& current,
                          const Camera& previous);

}  // namespace aftershade
