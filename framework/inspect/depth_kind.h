// Is a depth measured along the camera's axis, or from its position? By the positions of the same pixels.
#pragma once

#include <cstddef>
#include <string>

#include "framework/image/image.h"

namespace aftershade {

/// How well a picture's depth fits its positions in each reading: planar depth is an affine function of
/// position, with a gradient of length 1; radial depth is the distance to one point. Both are fitted by least
/// squares, so neither the camera nor the space of the positions matters, as long as depth and position have
/// one unit.
struct DepthKind {
    double planar_error = 0;  ///< root mean square, as a share of the median depth
    double radial_error = 0;
    double planar_off = 0;  ///< share of the pixels whose depth is off by more than 1 % of the median depth
    double radial_off = 0;
    std::size_t pixels = 0;  ///< that were looked at; 0 where there are too few

    enum class Verdict { planar, radial, unknown };
    /// unknown unless one reading fits to 1 % and the other four times worse.
    Verdict verdict() const;
    /// Neither reading fits, and not only at edges, where pixels may be averages.
    bool contradicts() const;
    std::string text() const;  ///< "planar, fits position to 0.02 %"; "" where the verdict is unknown
};

/// `depth` has one channel, m; `position` three. Both of one size. Pixels without a hit, infinite or 0 in
/// both, are left out. [thread-safe]
DepthKind find_depth_kind(const Image& depth, const Image& position);

}  // namespace aftershade
