// What dof_layered must do, against closed forms and against a renderer's own lens.
#include "tests/aperture_family.h"

namespace aftershade::test::dof_layered {
namespace {

struct Named {
    static constexpr const char* kEffect = "dof_layered";
};
INSTANTIATE_TYPED_TEST_SUITE_P(DofLayered, ApertureOfBlades, Named);

TEST(DofLayered, SeesThroughTheEdgeOfANearObjectWhatItFillsInBehindIt) {
    expect_near_ramp(near_box_over_focus(Named::kEffect), 48, 0.03f);
}

/// A slanted plane lies in many layers; where its own light is even, no layer may show through another.
TEST(DofLayered, KeepsASurfaceAcrossLayersWhole) {
    const SyntheticBox box{.x = 0, .y = 0, .width = 96, .height = 64, .color = {0.5f, 0.5f, 0.5f}};
    Capture capture = make_capture({.width = 96, .height = 96, .background = {0, 0, 0}, .box = box}, 0);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) capture.images["depth"].at(x, y, 0) = 1 + float(y) / 64;
    const Image out = through_aperture(Named::kEffect, capture, 12);
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 96; ++x) ASSERT_NEAR(out.at(x, y, 0), 0.5f, 0.005f) << x << " " << y;
}

/// The sharp input has 21.7 dB, a plain layered reference with 30 layers 30.2.
TEST(DofLayeredOnSuzanne, ComesCloseToTheRenderersLens) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    EXPECT_GE(suzanne_through_aperture_db(Named::kEffect, *folder), 32.5);  // measured 33.09
}

}  // namespace
}  // namespace aftershade::test::dof_layered
