// Runs the effect alone, and looks at its picture.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "framework/image/false_color.h"
#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

/// `rest` of the step after its effect: R"(, "in": {...})".
inline std::string look(const std::string& params, const std::string& rest = "",
                        const std::string& before = "") {
    return R"({"aftershade": 1, "steps": [)" + before + R"({"effect": "visualize", "params": {)" + params +
           "}" + rest + "}]}";
}

inline Image shown(const Capture& capture, const std::string& params, const std::string& rest = "",
                   const std::string& before = "") {
    return LookRunner(look(params, rest, before), gpu::test_backend()).run(capture).images.at("display");
}

inline DisplayColor at(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

inline void expect_color(const Image& image, int x, int y, DisplayColor expected, const std::string& what) {
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(image.at(x, y, int(c)), expected[c], 2e-5)
            << what << " at (" << x << ", " << y << "), channel " << c;
}

inline void set_velocity(Capture& capture, int x, int y, float vx, float vy) {
    capture.images.at("velocity").at(x, y, 0) = vx;
    capture.images.at("velocity").at(x, y, 1) = vy;
}

inline Capture moving(int width, int height, float vx, float vy) {
    Capture capture = make_capture({.width = width, .height = height, .background = {0.5f, 0.5f, 0.5f}});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) set_velocity(capture, x, y, vx, vy);
    return capture;
}

}  // namespace aftershade::test
