// Captures and parameters that the tests of this effect share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "framework/scene/scene_renderer.h"
#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/reference/burley.h"
#include "tests/scene/scene_text.h"

namespace aftershade::test::preintegrated {

constexpr double kPi = 3.14159265358979323846;

/// Irradiance after the effect with these parameters, as JSON.
inline Image scattered(const Capture& capture, const std::string& params) {
    LookRunner runner(
        R"({"aftershade": 1, "steps": [{"effect": "sss_preintegrated", "params": {)" + params + "}}]}",
        gpu::test_backend(), {"sss_preintegrated.irradiance"});
    return runner.run(capture).taps.at("sss_preintegrated.irradiance");
}

inline std::string burley(const std::array<double, 3>& d_mm) {
    return fmt::format(R"("scattering_profile": {{"type": "burley", "d_mm": [{}, {}, {}]}})", d_mm[0],
                       d_mm[1], d_mm[2]);
}

inline CaptureLight sun(const std::array<double, 3>& direction, double intensity = kPi) {
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    CaptureLight light;
    light.kind = CaptureLight::Kind::directional;
    for (std::size_t c = 0; c < 3; ++c) light.direction[c] = direction[c] / length;
    light.intensity = {intensity, intensity, intensity};
    return light;
}

/// Largest difference of two pictures over the pixels of object 1.
inline double worst(const Capture& capture, const Image& a, const Image& b, int channel) {
    double result = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            if (capture.images.at("object_id").uint_at(x, y, 0) == 1)
                result = std::max(result, std::abs(double(a.at(x, y, channel)) - b.at(x, y, channel)));
    return result;
}

/// A plane 5 m away of which 480 px show 3.6 m, under a light that shines straight at it: its irradiance
/// is 1.
inline Capture plane(int width = 480, int height = 8) {
    const scene::Scene scene = scene::scene_of(R"({ "aftershade": 1,
        "camera": { "position": [0, 0, 5], "focal_length": 50 }, "materials": { "wax": {} },
        "objects": [ { "id": 1, "shape": "plane", "size": [30, 30], "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [0, 0, 1], "intensity": 3.14159265358979 } ] })");
    Capture capture = scene::SceneRenderer(scene, width, height, 2).render_capture(1);
    capture.header.lights = {sun({0, 0, -1})};
    return capture;
}
constexpr double kMmPerPx = 5000.0 * 36 / 50 / 480;

inline void shade(Capture& capture, const std::function<double(double x, double y)>& share) {
    Image& light = capture.images.at("irradiance");
    for (int y = 0; y < light.height(); ++y)
        for (int x = 0; x < light.width(); ++x)
            for (int c = 0; c < 3; ++c)
                light.at(x, y, c) *=
                    float(share(x + 0.5 - light.width() / 2.0, y + 0.5 - light.height() / 2.0));
}

inline const std::array<double, 3> kEdgeD{120, 90, 60};  // mm: 16, 12 and 8 px

/// Burley's edge response, also on the dark side.
inline double edge(double x, double d) {
    if (x == 0) return 0.5;
    return x > 0 ? reference::burley_edge_response(x, d) : 1 - reference::burley_edge_response(-x, d);
}

/// A ball of 1 m under a light from its left.
inline Capture ball(int size = 64, const std::string& more = "") {
    const scene::Scene scene = scene::scene_of(R"({ "aftershade": 1,
        "camera": { "position": [0, 0, 6], "focal_length": 90 }, "materials": { "wax": {} },
        "objects": [ { "id": 1, "shape": "sphere", "radius": 1, "material": "wax" } ],
        "lights": [ { "type": "directional", "position": [1, 0, 0], "intensity": 3.14159265358979 } ] )" +
                                               more + "}");
    Capture capture = scene::SceneRenderer(scene, size, size, 2).render_capture(1);
    capture.header.lights = {sun({-1, 0, 0})};
    return capture;
}

}  // namespace aftershade::test::preintegrated
