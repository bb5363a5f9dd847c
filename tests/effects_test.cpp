// What holds for every effect, found by its folder: it compiles in every variant, its output is finite over
// the range of every parameter, its identity is one, both software backends agree, and it has cases, whose
// goldens the suite of tests/golden holds.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "framework/batch/approved_image.h"
#include "framework/batch/golden_case.h"
#include "framework/core/units.h"
#include "framework/effect/usage_check.h"
#include "framework/image/capture.h"
#include "framework/image/png_file.h"
#include "framework/image/profile.h"
#include "framework/image/role.h"
#include "tests/camera_pose.h"
#include "tests/look_runner.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = AFTERSHADE_SOURCE_DIR;

// ---- the effects ----

EffectRegistry& registry() {
    static EffectRegistry effects({kRoot / "effects"});
    return effects;
}

std::string faults_of(const Diagnostics& diagnostics) {
    std::ostringstream text;
    diagnostics.print(text);
    return text.str();
}

/// The software backends of this machine. None at all is a failure of every test here.
const std::vector<gpu::Backend>& backends() {
    static const std::vector<gpu::Backend> present = [] {
        std::vector<gpu::Backend> usable;
        for (const gpu::BackendReport& report : gpu::probe_backends())
            if (report.usable && report.info.software) usable.push_back(report.info.backend);
        return usable;
    }();
    return present;
}

// ---- looks ----

std::string json_of(const ParamValue& value) {
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

std::string look_of(const std::string& effect, const Values& values) {
    std::string params;
    for (const auto& [name, value] : values)
        params += (params.empty() ? "\"" : ", \"") + name + "\": " + json_of(value);
    return R"({"aftershade": 1, "steps": [{"effect": ")" + effect + R"(", "params": {)" + params + "}}]}";
}

/// A limit of a parameter as a value of its type; a vector has it in every component.
ParamValue limit_of(const ParamSpec& spec, double limit) {
    if (spec.type == ParamType::int_) return std::int64_t(limit);
    if (const int count = component_count(spec.type); count > 1)
        return std::vector<double>(std::size_t(count), limit);
    return limit;
}

/// Every value of an enum or a bool; the limits of a number.
std::vector<ParamValue> extremes_of(const ParamSpec& spec) {
    std::vector<ParamValue> values;
    if (spec.type == ParamType::bool_) return {false, true};
    for (const std::string& name : spec.values) values.emplace_back(name);
    if (spec.min) values.push_back(limit_of(spec, *spec.min));
    if (spec.max) values.push_back(limit_of(spec, *spec.max));
    return values;
}

// ---- captures ----

/// A sphere and a moving box before nothing, lights brighter than white, and coverage that ends.
Capture small_capture() {
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
Capture capture_before() {
    Capture capture = small_capture();
    capture.header.frame -= 1;
    const CameraPose pose{.position_m = {-0.1, 0.05, 0.2}, .angles_deg = {1, -3, 2}};
    set_pose(capture.header.camera, pose, capture.images.at("color").width(),
             capture.images.at("color").height());
    return capture;
}

void remove_role(Capture& capture, const std::string& role) {
    capture.images.erase(role);
    std::erase(capture.header.roles, role);
}

/// The first value of the images that is no number.
std::string non_finite(const FrameResult& result) {
    for (const auto& [role, image] : result.images)
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int c = 0; c < image.channels(); ++c)
                    if (!std::isfinite(image.at(x, y, c)))
                        return role + " at (" + std::to_string(x) + ", " + std::to_string(y) + "), channel " +
                               std::to_string(c) + ": " + std::to_string(image.at(x, y, c));
    return "";
}

bool same_bits(const Image& a, const Image& b) {
    return a.floats().size() == b.floats().size() &&
           std::memcmp(a.floats().data(), b.floats().data(), a.floats().size_bytes()) == 0;
}

// ---- one test for every folder ----

class EveryEffect : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        Diagnostics diagnostics;
        manifest_ = registry().find(GetParam(), diagnostics);
        ASSERT_TRUE(manifest_) << faults_of(diagnostics);
        ASSERT_FALSE(backends().empty()) << "neither osmesa nor egl-software works on this machine";
    }
    const EffectManifest& manifest() const { return *manifest_; }

    FrameResult run(const Values& values, gpu::Backend backend, const Capture& capture) const {
        const Capture before = with_aovs(capture_before()), whole = with_aovs(capture);
        FrameInputs frame;
        frame.capture = &whole;
        frame.previous = &before;
        return LookRunner(look_of(GetParam(), values), backend).run(frame);
    }

    /// With what no capture has by itself but the effect cannot do without: small numbers.
    Capture with_aovs(Capture capture) const {
        // Any of them: the test may have taken any role away.
        const Image& other = capture.images.begin()->second;
        for (const InputSpec& input : manifest().inputs) {
            if (!input.role.starts_with("aov:") || input.optional) continue;
            Image image(other.width(), other.height(), 4);
            for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = 0.001f * float(i % 5);
            capture.images[input.role] = std::move(image);
            capture.header.roles.push_back(input.role);
        }
        return capture;
    }

private:
    const EffectManifest* manifest_ = nullptr;
};

INSTANTIATE_TEST_SUITE_P(Effects, EveryEffect, testing::ValuesIn(registry().ids()),
                         [](const auto& effect) { return effect.param; });

TEST_P(EveryEffect, SaysWhatItAndItsParametersDo) {
    EXPECT_FALSE(manifest().summary.empty());
    EXPECT_FALSE(manifest().version.empty());
    for (const ParamSpec& spec : manifest().params) {
        EXPECT_TRUE(spec.doc.ends_with('.')) << spec.name << ": the doc is a sentence";
        const bool number = is_block_type(spec.type) && spec.type != aftershade::ParamType::bool_ &&
                            spec.type != aftershade::ParamType::enum_;
        EXPECT_EQ(number, spec.ui_range.has_value()) << spec.name << ": a number has a slider's ends";
        EXPECT_EQ(number, spec.min.has_value()) << spec.name << ": a number has a least value";
    }
    for (const TextureSpec& texture : manifest().textures) EXPECT_FALSE(texture.doc.empty()) << texture.name;
}

TEST_P(EveryEffect, CompilesInEveryVariantOnEachBackend) {
    for (const gpu::Backend backend : backends()) {
        const Capture capture = small_capture();
        EXPECT_NO_THROW(run({}, backend, capture));
        for (const ParamSpec& spec : manifest().params) {
            if (spec.bind != ParamBind::define) continue;
            for (const ParamValue& value : extremes_of(spec)) {
                if (value == spec.default_value) continue;
                EXPECT_NO_THROW(run({{spec.name, value}}, backend, capture))
                    << gpu::backend_name(backend) << ", " << spec.name << " = " << json_of(value);
            }
        }
        for (const InputSpec& input : manifest().inputs) {
            const auto is_required = [&](const InputSpec& other) {
                return !other.optional && other.role == input.role;
            };
            // A neighbouring frame's image may be absent where this frame's is needed.
            if (!input.optional || std::ranges::any_of(manifest().inputs, is_required)) continue;
            Capture without = small_capture();
            remove_role(without, input.role);
            EXPECT_NO_THROW(run({}, backend, without))
                << gpu::backend_name(backend) << ", without " << input.role;
        }
    }
}

TEST_P(EveryEffect, GivesNumbersOverTheRangeOfEveryParameter) {
    const Capture capture = small_capture();
    EXPECT_EQ(non_finite(run({}, backends().front(), capture)), "") << "at the defaults";
    for (const ParamSpec& spec : manifest().params)
        for (const ParamValue& value : extremes_of(spec)) {
            if (value == spec.default_value) continue;
            const FrameResult result = run({{spec.name, value}}, backends().front(), capture);
            ASSERT_FALSE(result.images.empty());
            EXPECT_EQ(non_finite(result), "") << spec.name << " = " << json_of(value);
        }
}

TEST_P(EveryEffect, LeavesColorAloneBitForBitWhereItsParametersSaySo) {
    const OutputSpec* output = manifest().find_output("color");
    const InputSpec* input = manifest().find_input("color");
    Values identity;
    for (const ParamSpec& spec : manifest().params)
        if (spec.identity) identity[spec.name] = *spec.identity;
    if (!output || !input || identity.empty())
        GTEST_SKIP() << "SKIPPED: " << GetParam() << " has no identity from color to color";
    const Capture capture = small_capture();
    const FrameResult result = run(identity, backends().front(), capture);
    EXPECT_TRUE(same_bits(result.images.at("color"), capture.images.at("color")));
    // And only there: some other value of them changes the picture.
    bool changes = false;
    for (const ParamSpec& spec : manifest().params) {
        if (!spec.identity || changes) continue;
        for (const ParamValue& value : extremes_of(spec)) {
            Values other = identity;
            other[spec.name] = value;
            const Image image = run(other, backends().front(), capture).images.at("color");
            changes |= !same_bits(image, capture.images.at("color"));
        }
    }
    EXPECT_TRUE(changes);
}

TEST_P(EveryEffect, DeclaresWhatItsShadersUseAndUsesWhatItDeclares) {
    Diagnostics faults;
    check_declared_used(manifest(), std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "glsl", faults);
    std::ostringstream text;
    faults.print(text);
    EXPECT_EQ(text.str(), "");
}

/// What came before a cut, a gap or another size must leave no trace.
TEST_P(EveryEffect, BeginsAnewAtACutAGapAndAnotherSize) {
    const auto frame_of = [&](int number, int width) {
        return with_aovs(make_capture({.width = width,
                                       .height = 20,
                                       .background = {0.1f * float(number), 0.5f, 0.2f},
                                       .background_depth_m = 5,
                                       .box = SyntheticBox{4, 4, 8, 6, 2, 0, 2}},
                                      number));
    };
    const auto run_one = [](LookRunner& runner, const Capture& capture, bool cut) {
        FrameInputs frame;
        frame.capture = &capture;
        frame.begins_shot = cut;
        return runner.run(frame);
    };
    struct After {
        int number;
        int width;
        bool cut;
    };
    for (const After after : {After{3, 32, true}, After{9, 32, false}, After{3, 40, false}}) {
        LookRunner used(look_of(GetParam(), {}), backends().front());
        for (const int number : {1, 2}) run_one(used, frame_of(number, 32), false);
        LookRunner fresh(look_of(GetParam(), {}), backends().front());
        const Capture capture = frame_of(after.number, after.width);
        const FrameResult a = run_one(used, capture, after.cut), b = run_one(fresh, capture, false);
        for (const auto& [role, image] : a.images) EXPECT_TRUE(same_bits(image, b.images.at(role))) << role;
    }
}

TEST_P(EveryEffect, GivesTheSameBitsOnBothSoftwareBackends) {
    if (backends().size() < 2) GTEST_SKIP() << "SKIPPED: only one software backend works here";
    const Capture capture = small_capture();
    std::vector<Values> variants{{}};
    for (const ParamSpec& spec : manifest().params)
        if (spec.bind == ParamBind::define)
            for (const ParamValue& value : extremes_of(spec)) variants.push_back({{spec.name, value}});
    for (const Values& values : variants) {
        const FrameResult first = run(values, backends()[0], capture);
        const FrameResult second = run(values, backends()[1], capture);
        ASSERT_EQ(first.images.size(), second.images.size());
        for (const auto& [role, image] : first.images)
            EXPECT_TRUE(same_bits(image, second.images.at(role)))
                << role << " of " << look_of(GetParam(), values);
    }
}

// ---- cases ----

/// What they give, `aftershade golden run tests/golden` tells.
TEST_P(EveryEffect, HasCasesWhoseGoldensAreSmallAndSayWhatMadeThem) {
    constexpr int kMaxWidthPx = 256;
    constexpr std::uintmax_t kMaxBytes = 200'000;
    Diagnostics diagnostics;
    const auto cases = read_effect_cases(manifest().folder, kRoot, diagnostics);
    ASSERT_FALSE(diagnostics.has_errors()) << faults_of(diagnostics);
    EXPECT_FALSE(cases.empty()) << "no case in " << manifest().folder / "cases";
    for (const GoldenCase& test : cases) {
        EXPECT_TRUE(fs::is_regular_file(test.capture)) << test.capture;
        const std::vector<int> frames = parse_frame_range(test.frames).value_or(std::vector<int>{});
        ASSERT_FALSE(frames.empty()) << test.file;
        for (const std::string& stem : test.image_stems())
            for (const int frame : frames) {
                const fs::path path = test.goldens / (golden_image_name(stem, frame) + ".exr");
                ASSERT_TRUE(fs::exists(path)) << "aftershade golden approve tests/golden makes " << path;
                EXPECT_LE(fs::file_size(path), kMaxBytes) << path;
                const Window window = ExrFile(path).parts().front().data_window;
                EXPECT_LE(window.max_x - window.min_x + 1, kMaxWidthPx) << path;
                const auto approved = approved_images(test.goldens, path.stem().string(), {});
                for (const ApprovedImage& image : approved)
                    EXPECT_TRUE(image.sidecar) << "no sidecar of its own beside " << image.file;
            }
    }
}

}  // namespace
}  // namespace aftershade::test
