// What the tests of lens effects share: a look with one such effect, a lens of a wanted blur, and the picture
// of a light.
#pragma once

#include <string>

#include <fmt/format.h>

#include "tests/polygon.h"

namespace aftershade::test {

/// A lens that is focused at 2 m and whose CoC radius at infinity is `radius_px` in a picture `width_px`
/// wide, as members of "params". By the lens model `pinhole` a point at half the focus distance has minus
/// that radius.
struct Lens {
    double radius_px = 12;
    int width_px = 128;

    static constexpr double kFocusM = 2, kSensorWidthMm = 36, kFocalLengthMm = 200;

    std::string params() const {
        const double aperture_mm =
            2 * radius_px * kSensorWidthMm / width_px * (kFocusM * 1000) / kFocalLengthMm;
        return fmt::format(R"("focus_distance": {}, "sensor_width": {}, "lens_model": "pinhole",
                              "focal_length": {}, "f_number": {})",
                           kFocusM, kSensorWidthMm, kFocalLengthMm, kFocalLengthMm / aperture_mm);
    }

    /// `more`: further members of "params".
    std::string look(const std::string& effect, const std::string& more = "") const {
        return fmt::format(R"({{"aftershade": 1, "steps": [{{"effect": "{}", "params": {{{}{}}}}}]}})",
                           effect, params(), more.empty() ? "" : ", " + more);
    }
};

/// Coverage by what a square light of `side_px` (odd) makes of an outline: the mean of the outline at each of
/// its pixels.
inline Image coverage_of_light(const std::vector<Vertex>& outline, int size, int center, int side_px) {
    Image sum(size, size, 1);
    const int half = side_px / 2;
    for (int j = -half; j <= half; ++j)
        for (int i = -half; i <= half; ++i) {
            const Image one = coverage(outline, size, size, center + i, center + j);
            for (std::size_t k = 0; k < sum.floats().size(); ++k)
                sum.floats()[k] += one.floats()[k] / float(side_px * side_px);
        }
    return sum;
}

}  // namespace aftershade::test
