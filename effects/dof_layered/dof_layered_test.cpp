// What dof_layered must do, against closed forms and against a renderer's own lens.
#include "tests/aperture_checks.h"

namespace aftershade::test {
namespace {

const std::string kEffect = "dof_layered";

class DofLayeredPoint : public testing::TestWithParam<AperturePoint> {};

TEST_P(DofLayeredPoint, IsTheApertureWithAllItsEnergy) {
    expect_point_is_the_aperture(kEffect, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Shapes, DofLayeredPoint,
                         testing::Values(AperturePoint{3, 8.2, 0, false}, AperturePoint{3, 24.2, 0, true},
                                         AperturePoint{5, 8, 0, true}, AperturePoint{5, 24, 11, false},
                                         AperturePoint{6, 8, 0, false}, AperturePoint{6, 24.5, 30, true},
                                         AperturePoint{7, 8, 0, true}, AperturePoint{7, 33, 20, false},
                                         AperturePoint{0, 20, 0, false}, AperturePoint{6, 20, 0, true, 1}));
INSTANTIATE_TEST_SUITE_P(Energy, DofLayeredPoint,
                         testing::Values(AperturePoint{6, 0.6, 0, false}, AperturePoint{5, 1.3, 0, true},
                                         AperturePoint{0, 2.7, 0, false}, AperturePoint{7, 5.1, 3, true},
                                         AperturePoint{6, 60.2, 0, false},
                                         AperturePoint{5, 17.3, 8, true, 0.5}));

TEST(DofLayered, LeavesAUniformImageUnchanged) {
    expect_uniform_stays_uniform(kEffect, "");
    expect_uniform_stays_uniform(kEffect, R"("blades": 5, "rotation": 17, "curvature": 0.4)");
}

TEST(DofLayered, CopiesPixelsInFocusBitForBit) {
    expect_focus_stays_bit_for_bit(kEffect);
}

TEST(DofLayered, KeepsAFocusedObjectOutOfTheBlurBehindIt) {
    expect_focus_leaks_at_most(kEffect, 0.01f);
}

TEST(DofLayered, BlursAlphaWithTheColorThatItCovers) {
    expect_alpha_blurs_with_color(kEffect);
}

TEST(DofLayered, GivesTheSameBitsOnBothSoftwareBackends) {
    expect_same_bits_on_both_backends(kEffect);
}

TEST(DofLayered, MakesNoLightAndNoNumberThatIsNone) {
    expect_no_light_is_made(kEffect);
}

TEST(DofLayered, SeesThroughTheEdgeOfANearObjectWhatItFillsInBehindIt) {
    expect_near_ramp(near_box_over_focus(kEffect), 48, 0.03f);
}

/// A slanted plane lies in many layers; where its own light is even, no layer may show through another.
TEST(DofLayered, KeepsASurfaceAcrossLayersWhole) {
    const SyntheticBox box{.x = 0, .y = 0, .width = 96, .height = 64, .color = {0.5f, 0.5f, 0.5f}};
    Capture capture = make_capture({.width = 96, .height = 96, .background = {0, 0, 0}, .box = box}, 0);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) capture.images["depth"].at(x, y, 0) = 1 + float(y) / 64;
    const Image out = through_aperture(kEffect, capture, 12);
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 96; ++x) ASSERT_NEAR(out.at(x, y, 0), 0.5f, 0.005f) << x << " " << y;
}

/// The sharp input has 21.7 dB, a plain layered reference with 30 layers 30.2.
TEST(DofLayeredOnSuzanne, ComesCloseToTheRenderersLens) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    EXPECT_GE(suzanne_through_aperture_db(kEffect, *folder), 32.5);  // measured 33.09
}

}  // namespace
}  // namespace aftershade::test
