// Looks and lenses that the tests of this effect share.
#pragma once

#include <string>

#include <fmt/format.h>

#include "framework/capture/capture.h"
#include "tests/backends.h"
#include "tests/look_runner.h"

namespace aftershade::test::bokeh {

constexpr double kFocusM = 2, kSensorWidthMm = 36;  // the focal length is the manifest's default, 50 mm

inline std::string look(const std::string& params) {
    return fmt::format(R"({{"aftershade": 1, "steps": [{{"effect": "bokeh", "params": {{
        "focus_distance": {}, "sensor_width": {}, {}}}}}]}})",
                       kFocusM, kSensorWidthMm, params);
}

/// A pinhole lens that gives a point at infinity this CoC radius in an image `width_px` wide. At half the
/// focus distance the radius is minus that.
inline std::string lens(double radius_px, int width_px) {
    const double focal_length_mm = 200;
    const double aperture_mm = 2 * radius_px * kSensorWidthMm / width_px * (kFocusM * 1000) / focal_length_mm;
    return fmt::format(R"("lens_model": "pinhole", "focal_length": {}, "f_number": {})", focal_length_mm,
                       focal_length_mm / aperture_mm);
}

inline Image color(const Capture& capture, const std::string& params,
                   gpu::Backend backend = gpu::test_backend()) {
    return LookRunner(look(params), backend).color(capture);
}

}  // namespace aftershade::test::bokeh
