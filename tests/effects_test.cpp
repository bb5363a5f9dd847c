// What holds for every effect, found by its folder: it compiles in every variant, its output is finite over
// the range of every parameter, its identity is one, both software backends agree, and it has cases, whose
// goldens the suite of tests/golden holds.
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "framework/capture/frame_range.h"
#include "framework/document/param_type.h"
#include "framework/effect/usage_check.h"
#include "framework/golden/approved_image.h"
#include "framework/golden/golden_case.h"
#include "tests/every_effect.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

INSTANTIATE_TEST_SUITE_P(Effects, EveryEffect, testing::ValuesIn(registry().ids()),
                         [](const auto& effect) { return effect.param; });

TEST_P(EveryEffect, SaysWhatItAndItsParametersDo) {
    EXPECT_FALSE(manifest().summary.empty());
    EXPECT_FALSE(manifest().version.empty());
    for (const ParamSpec& spec : manifest().params) {
        EXPECT_TRUE(spec.doc.ends_with('.')) << spec.name << ": the doc is a sentence";
        const bool number = is_block_type(spec.type) && spec.type->has_range;
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
            const bool may_lack = input.optional && input.instead.empty();
            if (!may_lack || std::ranges::any_of(manifest().inputs, is_required)) continue;
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
TEST_P(EveryEffect, RestartsAtACutAGapAndAnotherSize) {
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
