// What dof_layered must do, against closed forms and against a renderer's own lens.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "framework/image/role.h"
#include "tests/aperture_family.h"
#include "tests/lens.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test::dof_layered {
namespace {

struct Named {
    static constexpr const char* kEffect = "dof_layered";
};
INSTANTIATE_TYPED_TEST_SUITE_P(DofLayered, ApertureOfBlades, Named);

TEST(DofLayered, SeesThroughTheEdgeOfANearObjectWhatItFillsInBehindIt) {
    expect_near_ramp(near_box_over_focus(Named::kEffect), 48, 0.03f);
}

/// A strip of 8 px at half the focus distance hides a green part of a grey wall in focus. In its middle the
/// lens sees past it the very point of the wall behind it: the part of the aperture's disk that the strip
/// leaves open.
TEST(DofLayered, TakesWhatLiesBehindFromTheSecondLayerOfTheCapture) {
    constexpr int kSide = 128, kLeft = 60, kWidth = 8;
    const Lens lens;
    const SyntheticBox box{.x = kLeft, .y = 0, .width = kWidth, .height = kSide, .color = {0.8f, 0, 0}};
    Capture capture = make_capture({.width = kSide,
                                    .height = kSide,
                                    .background = {0.25f, 0.25f, 0.25f},
                                    .background_depth_m = 2,
                                    .box = box},
                                   0);
    const auto middle = [&] {
        const Image out =
            run_step(Named::kEffect, capture, lens.params() + ", \"blades\": 0").images.at("color");
        return out.at(kSide / 2, kSide / 2, 1);
    };
    EXPECT_LT(middle(), 0.25f);  // the guess knows no green
    Image color(kSide, kSide, 4), depth(kSide, kSide, 1);
    std::ranges::fill(depth.floats(), std::numeric_limits<float>::infinity());
    for (int y = 0; y < kSide; ++y)
        for (int x = kLeft; x < kLeft + kWidth; ++x) {
            color.at(x, y, 1) = color.at(x, y, 3) = 1;
            depth.at(x, y, 0) = 2;
        }
    capture.images[RoleId::of_layer(1, "color")] = std::move(color);
    capture.images[RoleId::of_layer(1, "depth")] = std::move(depth);
    const double h = kWidth / 2.0 / lens.radius_px;
    const double strip = 2 / std::numbers::pi * (std::asin(h) + h * std::sqrt(1 - h * h));
    EXPECT_NEAR(middle(), 1 - strip, 0.03);
}

/// The strip hides a green part of the wall again, which one other frame shows beside the strip.
TEST(DofLayered, TakesWhatLiesBehindFromAFrameUpToThreeAway) {
    constexpr int kSide = 128, kLeft = 60, kWidth = 8;
    const Lens lens;
    const auto capture_of = [&](int left, bool shows_green) {
        const SyntheticBox box{.x = left, .y = 0, .width = kWidth, .height = kSide, .color = {0.8f, 0, 0}};
        Capture capture = make_capture({.width = kSide,
                                        .height = kSide,
                                        .background = {0.25f, 0.25f, 0.25f},
                                        .background_depth_m = 2,
                                        .box = box},
                                       0);
        for (int y = 0; y < kSide && shows_green; ++y)
            for (int x = kLeft; x < kLeft + kWidth; ++x)
                for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = c == 1 ? 1.0f : 0.0f;
        return capture;
    };
    const Capture now = capture_of(kLeft, false), open = capture_of(8, true);
    const auto middle = [&](int offset, const std::string& background) {
        FrameInputs frame;
        frame.capture = &now;
        frame.neighbours[offset] = &open;
        const std::string params = lens.params() + R"(, "blades": 0, "background": ")" + background + "\"";
        Bench bench(EffectFolder(), look_of_step(Named::kEffect, params));
        return bench.run(frame).images.at("color").at(kSide / 2, kSide / 2, 1);
    };
    const double h = kWidth / 2.0 / lens.radius_px;
    const double strip = 2 / std::numbers::pi * (std::asin(h) + h * std::sqrt(1 - h * h));
    for (const int offset : {-3, -2, -1, 1, 2, 3})
        EXPECT_NEAR(middle(offset, "neighbours"), 1 - strip, 0.03) << offset;
    EXPECT_LT(middle(-1, "estimate"), 0.25f);
}

TEST(DofLayered, DrawsOneSurfaceOfASharedPixelByLot) {
    expect_wire_dissolves(Named::kEffect, 0.08);
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
