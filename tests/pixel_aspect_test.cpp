// Frames whose pixels are not square: steps that draw round shapes in pixels are named in a warning.
#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/every_effect.h"

namespace aftershade::test {
namespace {

bool warns(const std::string& effect, float aspect) {
    Diagnostics diagnostics;
    const EffectManifest* manifest = registry().find(effect, diagnostics);
    Capture capture = with_aovs(*manifest, small_capture());
    capture.header.pixel_aspect = aspect;
    const auto messages = LookRunner(look_of(effect, {}), backends().front()).run(capture).messages;
    const auto found = std::ranges::find_if(
        messages, [](const std::string& text) { return text.find("pixel aspect") != std::string::npos; });
    if (found == messages.end()) return false;
    EXPECT_TRUE(found->starts_with("warning: ")) << *found;
    EXPECT_NE(found->find("'" + effect + "'"), std::string::npos) << *found;
    EXPECT_NE(found->find("is " + format_number(double(aspect))), std::string::npos) << *found;
    return true;
}

TEST(PixelAspect, EveryEffectThatDrawsRoundShapesIsNamedAndNoOther) {
    // Each works by the pixel, along a velocity of both axes, or by what the camera's matrices say.
    const std::set<std::string> right = {"accumulate",   "camera_motion_blur",   "color_grade", "motion_blur",
                                         "sanitize",     "sss_combine",          "sss_prepare", "taa",
                                         "view_transform", "velocity_from_camera", "visualize"};
    for (const std::string& effect : registry().ids()) EXPECT_EQ(warns(effect, 2), !right.contains(effect)) << effect;
}

TEST(PixelAspect, SquarePixelsAreNoReasonToWarn) {
    for (const char* effect : {"bloom", "vignette", "dof", "film_grain"}) {
        EXPECT_FALSE(warns(effect, 1)) << effect;
        EXPECT_TRUE(warns(effect, 0.5f)) << effect;
    }
}

TEST(PixelAspect, TheWarningComesOnceForALookAndAgainWhereTheAspectChanges) {
    LookRunner runner(look_of("bloom", {}), backends().front());
    const auto messages_at = [&](float aspect, int frame) {
        Capture capture = small_capture();
        capture.header.frame = frame;
        capture.header.pixel_aspect = aspect;
        return runner.run(capture).messages.size();
    };
    EXPECT_EQ(messages_at(2, 1), 1u);
    EXPECT_EQ(messages_at(2, 2), 0u);
    EXPECT_EQ(messages_at(0.5f, 3), 1u);
    EXPECT_EQ(messages_at(1, 4), 0u);
}

}  // namespace
}  // namespace aftershade::test
