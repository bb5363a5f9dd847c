// Bars out of focus before stripes in focus, and their closed forms, for the tests of dof.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/aperture_checks.h"

namespace aftershade::test::dof {

inline constexpr int kWidth = 96, kHeight = 64;
inline constexpr double kRadiusPx = 16, kPi = 3.14159265358979;

/// Stripes along x, so that what a vertical bar hides is what stands beside it.
inline float stripe(int y) {
    return y / 8 % 2 == 0 ? 0.8f : 0.2f;
}

/// Columns from `left` on lie in front of stripes in focus; each has a light and a depth of its own.
struct Column {
    float light;
    bool is_near;
    float of_stripes = 0;  ///< share of the light behind that antialiasing mixed in
};

inline Capture columns_over_stripes(int left, const std::vector<Column>& columns) {
    Capture capture =
        make_capture({.width = kWidth, .height = kHeight, .background_depth_m = kApertureFocusM}, 0);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const int i = x - left;
            const bool is_bar = i >= 0 && i < int(columns.size());
            const Column column = is_bar ? columns[std::size_t(i)] : Column{0, false, 1};
            for (int c = 0; c < 3; ++c)
                capture.images["color"].at(x, y, c) =
                    column.light * (1 - column.of_stripes) + stripe(y) * column.of_stripes;
            if (column.is_near) capture.images["depth"].at(x, y, 0) = kApertureFocusM / 2;
        }
    return capture;
}

/// Share of a disk's area left of a line at `t` radii from its middle.
inline double disk_left_of(double t) {
    t = std::clamp(t, -1.0, 1.0);
    return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi;
}

/// Opacity at the middle of column `x` of a bar from `left` to `right`, px, through a disk.
inline double bar_opacity(int x, double left, double right) {
    return disk_left_of((right - x - 0.5) / kRadiusPx) - disk_left_of((left - x - 0.5) / kRadiusPx);
}

inline Image blurred(const Capture& capture) {
    return through_aperture("dof", capture, kRadiusPx, R"("blades": 0)");
}

}  // namespace aftershade::test::dof
