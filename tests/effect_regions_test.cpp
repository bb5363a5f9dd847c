// A region against the same pixels of the whole frame, for every effect there is.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "framework/capture/capture_window.h"
#include "framework/image/window.h"
#include "framework/look/reach.h"
#include "framework/render/renderer.h"
#include "tests/every_effect.h"

namespace aftershade::test {
namespace {

class EveryEffectsRegion : public EveryEffect {};
INSTANTIATE_TEST_SUITE_P(Effects, EveryEffectsRegion, testing::ValuesIn(registry().ids()),
                         [](const auto& effect) { return effect.param; });

constexpr int kWidth = 720, kHeight = 560;
/// Odd on purpose: no multiple of any tile.
constexpr Window kRegion{351, 271, 377, 292};

/// Surfaces at many depths, which move in many directions, with lights brighter than white.
Capture busy_capture(const EffectManifest& manifest) {
    Capture capture = make_capture({.width = kWidth,
                                    .height = kHeight,
                                    .background = {0.1f, 0.2f, 0.3f},
                                    .background_depth_m = 9,
                                    .sphere = SyntheticSphere{338, 274, 40, 2.0f},
                                    .box = SyntheticBox{358, 244, 60, 70, 9, -6, 1.2f}});
    std::uint32_t state = 7;
    const auto random = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) / float(1 << 24); };
    Image &color = capture.images.at("color"), &depth = capture.images.at("depth");
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool is_light = random() < 0.002f;
            for (int c = 0; c < 3; ++c) color.at(x, y, c) *= is_light ? 300.0f : 0.5f + random();
            if ((x / 37 + y / 29) % 3 == 0) depth.at(x, y, 0) = 0.8f + 0.7f * float((x / 37 + y / 29) % 7);
            for (const char* role : {"velocity", "velocity_next"}) {
                const auto image = capture.images.find(role);
                if (image == capture.images.end()) continue;
                image->second.at(x, y, 0) = 14.0f * std::sin(0.031f * float(x));
                image->second.at(x, y, 1) = 11.0f * std::cos(0.043f * float(y));
            }
        }
    set_pose(capture.header.camera, {}, kWidth, kHeight);
    return with_aovs(manifest, std::move(capture));
}

/// The effect with small values for what its reach counts, so that a region needs but a part of the frame,
/// and with a lens that blurs as far as it may.
Pipeline wide_open(const EffectManifest& manifest, const Values& chosen) {
    PipelineStep step;
    step.name = manifest.id;
    step.manifest = &manifest;
    for (const InputSpec& input : manifest.inputs) step.inputs[input.name] = {-1, input.image_role()};
    if (manifest.reach)
        for (const std::string& name : manifest.reach->params)
            step.values[name] = ParamValue(std::max(10.0, *manifest.find_param(name)->min));
    if (manifest.find_param("f_number")) step.values["f_number"] = ParamValue(0.2);
    for (const auto& [name, value] : chosen) step.values[name] = value;
    for (const auto& [name, value] : step.values) step.origins[name] = "the test";
    Pipeline pipeline;
    pipeline.steps.push_back(std::move(step));
    return pipeline;
}

FrameResult render(gpu::Context& context, const Pipeline& pipeline, const Capture& capture) {
    FrameInputs frame;
    frame.capture = &capture;
    PipelineRenderer renderer(context, pipeline, kRoot);
    std::vector<std::string> roles;
    for (const OutputSpec& output : pipeline.steps.front().manifest->outputs) roles.push_back(output.role);
    return renderer.render(frame, roles, false);
}

/// Filtering at a position relative to a texture's size rounds it, and so the position in px, by the size.
constexpr double kRounding_px = 2e-4;

bool filters_by_position(const EffectManifest& manifest) {
    return std::ranges::any_of(manifest.passes, [](const PassSpec& pass) {
        return std::ranges::any_of(pass.reads,
                                   [](const ReadSpec& read) { return read.filter == gpu::Filter::linear; });
    });
}

float greatest(const Image& image) {
    float most = 0;
    for (const float value : image.floats()) most = std::max(most, std::abs(value));
    return most;
}

float greatest_difference(const Image& a, const Image& b) {
    float most = 0;
    for (std::size_t i = 0; i < a.floats().size(); ++i)
        most = std::max(most, std::abs(a.floats()[i] - b.floats()[i]));
    return most;
}

TEST_P(EveryEffectsRegion, HasThePixelsOfTheWholeFrame) {
    std::vector<Values> variants{{}};
    for (const ParamSpec& spec : manifest().params)
        if (spec.bind == ParamBind::define)
            for (const ParamValue& value : extremes_of(spec)) variants.push_back({{spec.name, value}});
    gpu::Context context(backends().front());
    const Capture whole = busy_capture(manifest());
    bool has_part = false;
    for (const Values& values : variants) {
        const Pipeline pipeline = wide_open(manifest(), values);
        const auto needs = needs_of_region(pipeline, 1);
        if (!needs) continue;
        const Window window = window_with_needs(kRegion, *needs, whole.header.data_window);
        has_part |= !(window == whole.header.data_window);
        Capture part = whole;
        crop_capture(part, window);
        const FrameResult expected = render(context, pipeline, whole), got = render(context, pipeline, part);
        for (const auto& [role, image] : expected.images) {
            const Image in_whole = place_in_window(image, whole.header.data_window, kRegion, 0);
            const Image in_part = place_in_window(got.images.at(role), window, kRegion, 0);
            const std::string where = role + " of " + look_of(GetParam(), values) + ", " +
                                      std::to_string(needs->margin_px) + " px around the region";
            if (filters_by_position(manifest())) {
                EXPECT_LE(greatest_difference(in_whole, in_part), kRounding_px * greatest(in_whole)) << where;
            } else {
                EXPECT_TRUE(same_bits(in_whole, in_part)) << where;
            }
        }
    }
    const bool says_all = manifest().reach ? manifest().reach->is_all : !has_part;
    EXPECT_NE(has_part, says_all) << "the frame of the test is too small to hold a part of it";
}

}  // namespace
}  // namespace aftershade::test
