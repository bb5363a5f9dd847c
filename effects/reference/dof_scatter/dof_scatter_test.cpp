// What dof_scatter must do, against closed forms and against a renderer's own lens.
#include "framework/image/role.h"
#include "tests/aperture_family.h"

namespace aftershade::test::dof_scatter {
namespace {

struct Named {
    static constexpr const char* kEffect = "dof_scatter";
};
INSTANTIATE_TYPED_TEST_SUITE_P(DofScatter, ApertureOfBlades, Named);

/// Inside the silhouette a capture of one layer knows nothing of what lies behind: only the outer half is
/// looked at.
TEST(DofScatter, SpreadsANearObjectSoftlyOverWhatIsInFocus) {
    expect_near_ramp(near_box_over_focus(Named::kEffect), 64, 0.01f);
}

TEST(DofScatter, ShowsWhatTheSecondLayerHasInsideASilhouette) {
    const Image out = through_aperture(Named::kEffect, near_box_with_what_it_hides(), 12, R"("blades": 4)");
    expect_near_ramp(out, 48, 0.01f);
}

TEST(DofScatter, SpreadsEachLayerOfASharedPixelByItsShare) {
    expect_wire_dissolves(Named::kEffect, 0.01);
}

TEST(DofScatter, ShowsAFarPointOnlyWhereNothingInFocusCoversIt) {
    // The right half is in focus, and the point 4 px to its left, with a CoC radius of 12 px.
    Capture capture = make_capture({.width = 64, .height = 48, .points = {{28, 24, 1000}}});
    for (int y = 0; y < 48; ++y)
        for (int x = 32; x < 64; ++x) capture.images["depth"].at(x, y, 0) = kApertureFocusM;
    const Image out = through_aperture(Named::kEffect, capture, 12, R"("blades": 4)");
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
    EXPECT_GE(suzanne_through_aperture_db(Named::kEffect, *folder), 32.4);  // measured 33.00
}

}  // namespace
}  // namespace aftershade::test::dof_scatter
