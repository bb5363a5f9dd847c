// The same light in other primaries.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "framework/capture/capture.h"
#include "framework/image/color_space.h"
#include "framework/image/role.h"

namespace aftershade::test {

/// A capture of Rec. 709 with its light in the space of that name.
inline Capture in_space(Capture capture, const std::string& space) {
    const Chromaticities primaries = *color_space_primaries(space);
    for (auto& [role, image] : capture.images)
        if (kind_of_role(role) == RoleKind::light)
            convert_colors(image, conversion_matrix(kRec709, primaries));
    capture.header.primaries = primaries;
    return capture;
}

inline Image in_rec709(Image image, const std::string& space) {
    convert_colors(image, conversion_matrix(*color_space_primaries(space), kRec709));
    return image;
}

/// The largest difference of light, as a share of the value, or of 0.01 where that is more.
inline double largest_share(const Image& image, const Image& expected) {
    double largest = 0;
    for (std::size_t i = 0; i < expected.floats().size(); ++i) {
        const double value = expected.floats()[i];
        largest = std::max(largest, std::abs(image.floats()[i] - value) / std::max(std::abs(value), 0.01));
    }
    return largest;
}

}  // namespace aftershade::test
