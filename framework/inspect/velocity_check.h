// Do a capture's motion vectors mean what its profile says? Warps one of two consecutive frames by them and
// looks whether the other appears, for every way in which the profile can be wrong.
#pragma once

#include "framework/image/color_space.h"
#include "framework/image/image.h"
#include "framework/inspect/velocity_result.h"

namespace aftershade {

struct VelocityCheckInput {
    const Image* color_a = nullptr;  ///< scene-linear, three or more channels; frame A comes just before B
    const Image* color_b = nullptr;
    /// The role's image as the profile decoded it: two or more channels, px, +y down. nullptr: there is none.
    const Image* vectors_a = nullptr;
    const Image* vectors_b = nullptr;
    VelocitySettings settings;           ///< that decoded them
    Chromaticities primaries = kRec709;  ///< of both frames' colours
};

/// NaN and infinite vectors and those longer than the diagonal count as none; NaN colours are left out. The
/// same input gives the same bits. Throws Error(ErrorKind::capture) for images of different sizes and for
/// missing channels. [thread-safe]
VelocityCheck check_velocity(const VelocityCheckInput& input);

}  // namespace aftershade
