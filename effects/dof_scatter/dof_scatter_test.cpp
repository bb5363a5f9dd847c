// What dof_scatter must do, against closed forms and against a renderer's own lens.
#include "tests/aperture_checks.h"

namespace aftershade::test {
namespace {

const std::string kEffect = "dof_scatter";

class DofScatterPoint : public testing::TestWithParam<AperturePoint> {};

TEST_P(DofScatterPoint, IsTheApertureWithAllItsEnergy) {
    expect_point_is_the_aperture(kEffect, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Shapes, DofScatterPoint,
                         testing::Values(AperturePoint{3, 8.2, 0, false}, AperturePoint{3, 24.2, 0, true},
                                         AperturePoint{5, 8, 0, true}, AperturePoint{5, 24, 11, false},
                                         AperturePoint{6, 8, 0, false}, AperturePoint{6, 24.5, 30, true},
                                         AperturePoint{7, 8, 0, true}, AperturePoint{7, 33, 20, false},
                                         AperturePoint{0, 20, 0, false}, AperturePoint{6, 20, 0, true, 1}));
INSTANTIATE_TEST_SUITE_P(Energy, DofScatterPoint,
                         testing::Values(AperturePoint{6, 0.6, 0, false}, AperturePoint{5, 1.3, 0, true},
                                         AperturePoint{0, 2.7, 0, false}, AperturePoint{7, 5.1, 3, true},
                                         AperturePoint{6, 60.2, 0, false},
                                         AperturePoint{5, 17.3, 8, true, 0.5}));

TEST(DofScatter, LeavesAUniformImageUnchanged) {
    expect_uniform_stays_uniform(kEffect, "");
    expect_uniform_stays_uniform(kEffect, R"("blades": 5, "rotation": 17, "curvature": 0.4)");
}

TEST(DofScatter, CopiesPixelsInFocusBitForBit) {
    expect_focus_stays_bit_for_bit(kEffect);
}

TEST(DofScatter, KeepsAFocusedObjectOutOfTheBlurBehindIt) {
    expect_focus_leaks_at_most(kEffect, 0.01f);
}

TEST(DofScatter, BlursAlphaWithTheColorThatItCovers) {
    expect_alpha_blurs_with_color(kEffect);
}

TEST(DofScatter, GivesTheSameBitsOnBothSoftwareBackends) {
    expect_same_bits_on_both_backends(kEffect);
}

TEST(DofScatter, MakesNoLightAndNoNumberThatIsNone) {
    expect_no_light_is_made(kEffect);
}

/// Inside the silhouette a capture of one layer knows nothing of what lies behind: only the outer half is
/// looked at.
TEST(DofScatter, SpreadsANearObjectSoftlyOverWhatIsInFocus) {
    expect_near_ramp(near_box_over_focus(kEffect), 64, 0.01f);
}

TEST(DofScatter, ShowsAFarPointOnlyWhereNothingInFocusCoversIt) {
    // The right half is in focus, and the point 4 px to its left, with a CoC radius of 12 px.
    Capture capture = make_capture({.width = 64, .height = 48, .points = {{28, 24, 1000}}});
    for (int y = 0; y < 48; ++y)
        for (int x = 32; x < 64; ++x) capture.images["depth"].at(x, y, 0) = kApertureFocusM;
    const Image out = through_aperture(kEffect, capture, 12, R"("blades": 4)");
    // A square of 17 px a side, whose light is spread evenly; the pixels of the border fill in for those
    // without light.
    const double density = 1000 / (2 * 12.0 * 12.0);
    EXPECT_NEAR(double(out.at(22, 24, 0)), density, 0.01 * density);
    for (int y = 0; y < 48; ++y)
        for (int x = 32; x < 64; ++x) ASSERT_EQ(out.at(x, y, 0), 0) << x << " " << y;
}

/// The sharp input has 21.7 dB, a plain layered reference with 30 layers 30.2.
TEST(DofScatterOnSuzanne, ComesCloseToTheRenderersLens) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    EXPECT_GE(suzanne_through_aperture_db(kEffect, *folder), 32.4);  // measured 33.00
}

}  // namespace
}  // namespace aftershade::test
