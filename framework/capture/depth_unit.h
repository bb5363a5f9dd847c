// Whether a depth has the unit of the positions beside it.
#pragma once

#include "framework/image/image.h"

namespace aftershade {

/// Whether the depth is a distance along one axis in the positions' unit: an affine function of them whose
/// gradient is 1 long. False where the positions lie in a plane. Both over one grid. [thread-safe]
bool is_distance_of(const Image& depth, const Image& position);

}  // namespace aftershade
