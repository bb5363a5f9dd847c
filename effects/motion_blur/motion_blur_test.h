#pragma once
// What the tests of motion_blur share.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "framework/image/role.h"
#include "tests/backends.h"
#include "tests/motion_checks.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::motion_blur {

inline constexpr double kExposure = 0.5;  // frames, of the default shutter_angle

inline Image blur(const Capture& capture, const std::string& params = "") {
    LookRunner runner(look_of_step("motion_blur", params), gpu::test_backend());
    return runner.color(capture);
}

inline void set_velocity(Capture& capture, int x, int y, float vx, float vy) {
    for (const char* role : {"velocity", "velocity_next"}) {
        capture.images[role].at(x, y, 0) = vx;
        capture.images[role].at(x, y, 1) = vy;
    }
}

template <typename Function>
void each_pixel(const Image& image, Function function) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) function(x, y);
}

/// Infinite if one of the values is NaN.
inline double largest_difference(const Image& a, const Image& b) {
    double largest = 0;
    each_pixel(a, [&](int x, int y) {
        for (int c = 0; c < 3; ++c) {
            const double difference = std::abs(double(a.at(x, y, c)) - double(b.at(x, y, c)));
            if (std::isnan(difference)) largest = std::numeric_limits<double>::infinity();
            else largest = std::max(largest, difference);
        }
    });
    return largest;
}

/// Vertical stripes of different heights of light, over the whole picture.
inline Capture stripes(int width, int height, double depth_m = 5) {
    Capture capture = make_capture({.width = width, .height = height, .background_depth_m = float(depth_m)});
    Image& color = capture.images["color"];
    each_pixel(color, [&](int x, int y) {
        for (int c = 0; c < 3; ++c) color.at(x, y, c) = 0.25f + 0.5f * float((x * 7 + c * 3) % 11) / 11;
    });
    return capture;
}

/// A thing at rest, 2 m away, before a background that moves.
inline Capture pillar_before_moving_stripes(float speed_px) {
    Capture capture = stripes(160, 48);
    Image& color = capture.images["color"];
    each_pixel(color, [&](int x, int y) {
        const bool is_pillar = x >= 60 && x < 100;
        set_velocity(capture, x, y, is_pillar ? 0 : speed_px, 0);
        if (!is_pillar) return;
        capture.images["depth"].at(x, y, 0) = 2;
        capture.images["object_id"].uint_at(x, y, 0) = 2;
        for (int c = 0; c < 3; ++c) color.at(x, y, c) = 0.9f;
    });
    return capture;
}

/// Mean over the exposure of the part of pixel `x` that lies between two edges, which move by `way_px`.
inline double coverage(int x, double left, double right, double way_px) {
    constexpr int times = 256;
    double sum = 0;
    for (int i = 0; i < times; ++i) {
        const double shift = way_px * ((i + 0.5) / times - 0.5);
        sum += std::max(std::min(right + shift, x + 1.0) - std::max(left + shift, double(x)), 0.0);
    }
    return sum / times;
}

}  // namespace aftershade::test::motion_blur
