// Every effect at the ends of what a frame may be: a few pixels, the widest side, and alphas that hold no
// digits.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "framework/image/window.h"
#include "tests/every_effect.h"

namespace aftershade::test {
namespace {

class EffectAtTheEnds : public EveryEffect {
protected:
    Capture frame_of(int width, int height) const {
        Capture capture = make_capture({.width = width,
                                        .height = height,
                                        .background = {0.5f, 0.3f, 0.1f},
                                        .points = {{width / 2, height / 2, 100}}});
        set_pose(capture.header.camera, {}, width, height);
        return with_aovs(std::move(capture));
    }

    FrameResult run_at_defaults(const Capture& capture) const {
        FrameInputs frame;
        frame.capture = frame.neighbours[-1] = &capture;
        return LookRunner(look_of(GetParam(), {}), backends().front()).run(frame);
    }

    void expect_numbers(int width, int height) const {
        const FrameResult result = run_at_defaults(frame_of(width, height));
        EXPECT_EQ(non_finite(result), "") << width << " x " << height;
        for (const OutputSpec& output : manifest().outputs) {
            const auto made = result.images.find(output.role);
            ASSERT_TRUE(made != result.images.end()) << output.role;
            EXPECT_EQ(made->second.width(), width) << output.role;
            EXPECT_EQ(made->second.height(), height) << output.role;
        }
    }
};

INSTANTIATE_TEST_SUITE_P(Effects, EffectAtTheEnds, testing::ValuesIn(registry().ids()),
                         [](const auto& effect) { return effect.param; });

TEST_P(EffectAtTheEnds, GivesNumbersAtOneToThreePixelsASide) {
    for (const int width : {1, 2, 3})
        for (const int height : {1, 2, 3}) expect_numbers(width, height);
    for (const auto& [width, height] : {std::pair{1, 40}, std::pair{40, 1}, std::pair{17, 2}})
        expect_numbers(width, height);
}

/// bokeh_hexagon and film_grain draw to textures wider than the frame: a refusal then says which.
TEST_P(EffectAtTheEnds, GivesNumbersAtTheWidestSideOrSaysWhichTextureIsTooWide) {
    try {
        expect_numbers(16384, 2);
    } catch (const host::Error& error) {
        EXPECT_TRUE(GetParam() == "bokeh_hexagon" || GetParam() == "film_grain") << error.what();
        EXPECT_NE(error.message().find("texture '" + GetParam() + "."), std::string::npos) << error.what();
        EXPECT_NE(error.message().find("(GL_MAX_TEXTURE_SIZE)"), std::string::npos) << error.what();
    }
}

/// A firefly: light far above what the same frame has where alpha is 0.
TEST_P(EffectAtTheEnds, MakesNoFirefliesOfAlphasThatHoldNoDigits) {
    if (!manifest().find_input("color")) GTEST_SKIP() << "SKIPPED: " << GetParam() << " takes no colour";
    const auto greatest = [&](float alpha) {
        Capture capture = frame_of(24, 16);
        Image& color = capture.images.at("color");
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 24; ++x) {
                const std::array<float, 4> light = {2, 1, 0.2f, alpha};
                for (int c = 0; c < 4; ++c) color.at(x, y, c) = light[std::size_t(c)];
            }
        float most = 0;
        for (const auto& [role, image] : run_at_defaults(capture).images)
            if (role == "color" || role == "display")
                for (int y = 0; y < 16; ++y)
                    for (int x = 0; x < 24; ++x)
                        for (int c = 0; c < 3; ++c) most = std::max(most, image.at(x, y, c));
        return most;
    };
    const float uncovered = greatest(0);
    for (const float alpha : {1e-8f, 5.96e-8f, 1e-6f, 6e-5f})
        EXPECT_NEAR(greatest(alpha), uncovered, 1e-3f * uncovered + 1e-4f) << alpha;
}

TEST(EffectsOfAlpha, AGradeAtTheLeastAlphasIsThatOfLightWithoutCoverage) {
    const std::string grade = look_of_step(
        "color_grade", R"("exposure": 1, "contrast": 1.2, "saturation": 0.5, "offset": [0.1, 0.1, 0.1])");
    const auto graded = [&](float alpha) {
        Capture capture = make_capture({.width = 4, .height = 4});
        Image& color = capture.images.at("color");
        for (int x = 0; x < 4; ++x) {
            color.at(x, 0, 0) = 2;
            color.at(x, 0, 3) = alpha;
        }
        return LookRunner(grade, backends().front()).color(capture).at(1, 0, 0);
    };
    for (const float alpha : {1e-8f, 5.96e-8f, 3e-5f}) EXPECT_EQ(graded(alpha), graded(0)) << alpha;
    // From the least normal half on, light is that of the surface, times its coverage.
    EXPECT_GT(graded(6.2e-5f), 2 * graded(0));
}

}  // namespace
}  // namespace aftershade::test
