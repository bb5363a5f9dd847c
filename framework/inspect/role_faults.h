// Faults of the images of a frame's roles: each by itself, and compared with the others and the camera.
#pragma once

#include <string>
#include <vector>

#include "framework/capture/capture.h"

namespace aftershade {

/// Depth that contradicts position or camera, or is upside down against position. "" where there is none.
/// [thread-safe]
std::string find_position_fault(const Image& depth, const Image& position, const Camera& camera);

/// Normals in 0 to 1, or of another length than 1. Pixels of 0 have none. [thread-safe]
std::string find_normal_fault(const Image& normal);

}  // namespace aftershade
