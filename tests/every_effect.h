// What the tests of every effect have in common: the effects by their folders, looks, captures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/capture/capture.h"
#include "framework/color/color_transform.h"
#include "framework/document/units.h"
#include "framework/effect/registry.h"
#include "framework/gpu/context.h"
#include "tests/backends.h"
#include "tests/camera_pose.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

inline const std::filesystem::path kRoot = AFTERSHADE_SOURCE_DIR;

// ---- the effects ----

inline EffectRegistry& registry() {
    static EffectRegistry effects({kRoot / "effects"});
    return effects;
}

inline std::string faults_of(const Diagnostics& diagnostics) {
    std::ostringstream text;
    diagnostics.print(text);
    return text.str();
}

/// Those of gpu::test_backends() that this machine has. None at all is a failure of every test here.
inline const std::vector<gpu::Backend>& backends() {
    static const std::vector<gpu::Backend> present = [] {
        std::vector<gpu::Backend> usable;
        std::ranges::copy_if(gpu::test_backends(), std::back_inserter(usable),
                             [](gpu::Backend backend) { return gpu::why_not(backend).empty(); });
        return usable;
    }();
    return present;
}

// ---- looks ----

inline std::string json_of(const ParamValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return '"' + *text + '"';
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
    if (const auto* number = std::get_if<double>(&value)) return format_number(*number);
    std::string items;
    for (const double item : std::get<std::vector<double>>(value))
        items += (items.empty() ? "" : ", ") + format_number(item);
    return "[" + items + "]";
}

using Values = std::map<std::string, ParamValue>;

inline std::string look_of(const std::string& effect, const Values& values) {
    std::string params;
    for (const auto& [name, value] : values)
        params += (params.empty() ? "\"" : ", \"") + name + "\": " + json_of(value);
    return R"({"aftershade": 1, "steps": [{"effect": ")" + effect + R"(", "params": {)" + params + "}}]}";
}

/// Every value of an enum or a bool; the limits of a number.
inline std::vector<ParamValue> extremes_of(const ParamSpec& spec) {
    std::vector<ParamValue> values;
    for (SweepValue& one : sweep_values(spec)) values.push_back(std::move(one.value));
    return values;
}

// ---- captures ----

/// A sphere and a moving box before nothing, lights brighter than white, and coverage that ends.
inline Capture small_capture() {
    const SyntheticSphere sphere{.x = 20, .y = 18, .radius_px = 12, .depth_m = 2.5f};
    const SyntheticBox box{
        .x = 34, .y = 8, .width = 16, .height = 20, .velocity_x = 3, .velocity_y = -2, .depth_m = 4};
    Capture capture = make_capture({.background = {0.02f, 0.05f, 0.2f},
                                    .alpha = 0.5f,
                                    .sphere = sphere,
                                    .box = box,
                                    .points = {{5, 4, 1e4f}, {20, 18, 30}, {57, 30, 500}}});
    // Soft shading too: where all edges are hard, what sharpens within its neighbours' range has nothing to
    // do.
    Image& color = capture.images.at("color");
    for (int y = 0; y < color.height(); ++y)
        for (int x = 0; x < color.width(); ++x)
            for (int c = 0; c < 3; ++c)
                color.at(x, y, c) *= 1 + 0.3f * std::sin(0.6f * float(x) + 0.4f * float(y));
    // Something in every role that a formula leaves black.
    for (const char* role : {"specular", "emission"})
        for (float& value : capture.images.at(role).floats()) value = 0.1f;
    set_pose(capture.header.camera, {}, color.width(), color.height());
    return capture;
}

/// The frame before small_capture's, in which the camera stood and looked elsewhere.
inline Capture capture_before() {
    Capture capture = small_capture();
    capture.header.frame -= 1;
    const CameraPose pose{.position_m = {-0.1, 0.05, 0.2}, .angles_deg = {1, -3, 2}};
    set_pose(capture.header.camera, pose, capture.images.at("color").width(),
             capture.images.at("color").height());
    return capture;
}

inline void remove_role(Capture& capture, const std::string& role) {
    capture.images.erase(role);
    std::erase(capture.header.roles, role);
}

/// The first value of the images that is no number.
inline std::string non_finite(const FrameResult& result) {
    for (const auto& [role, image] : result.images)
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int c = 0; c < image.channels(); ++c)
                    if (!std::isfinite(image.at(x, y, c)))
                        return role + " at (" + std::to_string(x) + ", " + std::to_string(y) + "), channel " +
                               std::to_string(c) + ": " + std::to_string(image.at(x, y, c));
    return "";
}

inline bool same_bits(const Image& a, const Image& b) {
    return a.floats().size() == b.floats().size() &&
           std::memcmp(a.floats().data(), b.floats().data(), a.floats().size_bytes()) == 0;
}

/// With what no capture has by itself but the effect cannot do without: small numbers.
inline Capture with_aovs(const EffectManifest& manifest, Capture capture) {
    // Any of them: the test may have taken any role away.
    const Image& other = capture.images.begin()->second;
    for (const InputSpec& input : manifest.inputs) {
        const bool is_needed = !input.optional || !input.instead.empty();
        if (!input.role.starts_with("aov:") || !is_needed) continue;
        Image image(other.width(), other.height(), 4);
        for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = 0.001f * float(i % 5);
        capture.images[input.role] = std::move(image);
        capture.header.roles.push_back(input.role);
    }
    return capture;
}

class EveryEffect : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        Diagnostics diagnostics;
        manifest_ = registry().find(GetParam(), diagnostics);
        ASSERT_TRUE(manifest_) << faults_of(diagnostics);
        for (const ParamSpec& spec : manifest_->params)
            if (spec.file_kind == FileKind::ocio_config && !has_opencolorio())
                GTEST_SKIP() << "SKIPPED: built without OpenColorIO";
        ASSERT_FALSE(backends().empty()) << "neither osmesa nor egl-software works on this machine";
    }
    const EffectManifest& manifest() const { return *manifest_; }

    FrameResult run(const Values& values, gpu::Backend backend, const Capture& capture) const {
        const Capture before = with_aovs(capture_before()), whole = with_aovs(capture);
        FrameInputs frame;
        frame.capture = &whole;
        frame.neighbours[-1] = &before;
        return LookRunner(look_of(GetParam(), values), backend).run(frame);
    }

    Capture with_aovs(Capture capture) const { return test::with_aovs(manifest(), std::move(capture)); }

private:
    const EffectManifest* manifest_ = nullptr;
};

}  // namespace aftershade::test
