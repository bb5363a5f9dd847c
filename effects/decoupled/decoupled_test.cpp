// What decoupled must do, against closed forms, a renderer's lens, its shutter, and both at once.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/image/role.h"
#include "tests/aperture_checks.h"
#include "tests/backends.h"
#include "tests/motion_checks.h"
#include "tests/real_captures.h"

namespace aftershade::test::decoupled {
namespace {

constexpr const char* kEffect = "decoupled";

Image through(const Capture& capture, double radius_px, const std::string& more = "") {
    return through_aperture(kEffect, capture, radius_px, more);
}

// ---- the lens ----

TEST(Decoupled, MakesOfASmallLightTheApertureAndKeepsItsEnergy) {
    struct Light {
        int blades;
        double radius_px;
        bool near;
    };
    for (const Light& light : {Light{6, 24.5, true}, Light{5, 12, false}, Light{0, 20, false}}) {
        const int center = int(std::ceil(light.radius_px)) + 3, size = 2 * center + 1;
        const Image out = through(point_of_light(size, light.near), light.radius_px,
                                  fmt::format(R"("blades": {}, "rotation": 10)", light.blades));
        EXPECT_NEAR(sum_of(out) / double(kPointIntensity), 1, 0.02) << light.blades;
        const auto outline = regular_polygon(light.blades < 3 ? 256 : light.blades, light.radius_px,
                                             10 + (light.near ? 180 : 0));
        const Image polygon = coverage(outline, size, size, center, center);
        EXPECT_GE(shape_iou(out, double(out.at(center, center, 0)), polygon), 0.97) << light.blades;
    }
}

TEST(Decoupled, LeavesAUniformPictureUniformAtRandomDepths) {
    expect_uniform_stays_uniform(kEffect, "");
    expect_uniform_stays_uniform(kEffect, R"("samples": 8, "blades": 5)");
}

TEST(Decoupled, CopiesWhatIsInFocusAndAtRestBitForBit) {
    expect_picture_in_focus_is_copied(kEffect);
    expect_focus_stays_bit_for_bit(kEffect);
}

TEST(Decoupled, KeepsAFocusedObjectOutOfTheBlurBehindIt) {
    expect_focus_leaks_at_most(kEffect, 0.01f);
}

TEST(Decoupled, SpreadsANearObjectSoftlyOverWhatIsInFocus) {
    expect_near_ramp(near_box_over_focus(kEffect), 48, 0.03f);
}

/// What the picture hides is a chequer of its own, of which no estimate could have an idea.
TEST(Decoupled, ShowsTheSecondLayerWhereTheLensSeesAroundTheFirst) {
    Capture capture = near_box_before_focus();
    Image color(96, 48, 4), depth(96, 48, 1);
    const auto hidden = [](int y) { return y / 8 % 2 == 0 ? 0.9f : 0.3f; };
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) {
            depth.at(x, y, 0) = x >= 30 && x < 64 ? kApertureFocusM : kApertureFarM;
            for (int c = 0; c < 4 && x >= 30 && x < 64; ++c) color.at(x, y, c) = c == 3 ? 1 : hidden(y);
        }
    const Image guessed = through(capture, 12, R"("blades": 4)");
    capture.images[RoleId::of_layer(1, "color")] = std::move(color);
    capture.images[RoleId::of_layer(1, "depth")] = std::move(depth);
    const Image seen = through(capture, 12, R"("blades": 4)");
    const double reach_px = 12 / std::sqrt(2.0);
    for (int x = 57; x < 64; ++x) {
        const double covered = std::clamp((64 + reach_px - (x + 0.5)) / (2 * reach_px), 0.0, 1.0);
        EXPECT_NEAR(seen.at(x, 20, 0), covered + (1 - covered) * double(hidden(20)), 0.03) << x;
        EXPECT_NEAR(guessed.at(x, 20, 0), covered + (1 - covered) * double(kApertureDark), 0.05) << x;
    }
}

/// Of an antialiased column half of the samples see the bar and half what is behind it.
TEST(Decoupled, SharesAPixelOfTwoLayersByItsAlpha) {
    Capture capture = make_capture({.width = 64, .height = 32, .background_depth_m = kApertureFocusM}, 0);
    for (int layer = 0; layer < 2; ++layer) {
        Image color(64, 32, 4), depth(64, 32, 1);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x) {
                const float alpha = layer == 1 || x < 32 ? 1.0f : x == 32 ? 0.25f : 0.0f;
                for (int c = 0; c < 4; ++c) color.at(x, y, c) = alpha * (c == 3 ? 1.0f : layer ? 0.2f : 0.8f);
                depth.at(x, y, 0) = alpha == 0 ? kApertureFarM
                                    : layer    ? 2 * kApertureFocusM
                                               : kApertureFocusM;
            }
        capture.images[RoleId::of_layer(layer, "color")] = std::move(color);
        capture.images[RoleId::of_layer(layer, "depth")] = std::move(depth);
    }
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const float front = x < 32 ? 1.0f : x == 32 ? 0.25f : 0.0f;
            for (int c = 0; c < 3; ++c)
                capture.images["color"].at(x, y, c) = 0.8f * front + 0.2f * (1 - front);
            capture.images["depth"].at(x, y, 0) = x < 32 ? kApertureFocusM : 2 * kApertureFocusM;
        }
    const Image out = through(capture, 10);
    for (int y = 12; y < 20; ++y) {
        EXPECT_NEAR(out.at(31, y, 0), 0.8, 1e-6);
        EXPECT_NEAR(out.at(32, y, 0), 0.25 * 0.8 + 0.75 * 0.2, 0.02);
        EXPECT_NEAR(out.at(33, y, 0), 0.2, 1e-6);
    }
}

TEST(DecoupledOnSuzanne, ComesCloseToTheRenderersLens) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    EXPECT_GE(suzanne_through_aperture_db(kEffect, *folder, R"("shutter_angle": 0)"),
              32.5);  // measured 33.04
}

// ---- the shutter ----

constexpr const char* kSharpLens = R"("f_number": 1000, "focal_length": 1)";

Image moved(const Capture& capture, const std::string& more = "") {
    const std::string params = std::string(kSharpLens) + (more.empty() ? "" : ", " + more);
    return run_step(kEffect, capture, params).images.at("color");
}

TEST(Decoupled, OfABoxThatMovesIsATrapezoidOfTheShuttersLength) {
    // A box of 16 px that moves right by 24 px a frame: 12 px while the shutter is open.
    SyntheticScene scene{.width = 128, .height = 32, .background_depth_m = 5};
    scene.box = SyntheticBox{.x = 32, .y = 0, .width = 16, .height = 32, .velocity_x = 24, .depth_m = 2};
    const Capture capture = make_capture(scene, 1);  // from 56 to 72
    const double box = double(capture.images.at("color").at(64, 16, 0));
    const auto expect_from = [&](const char* phase, double opens_px) {
        const Image out = moved(capture, fmt::format(R"("shutter_phase": "{}")", phase));
        for (int x = 30; x < 100; ++x) {
            // How long the box, of whole pixels, covers this one: from where it begins until where it ends.
            const double begins = std::clamp((x - 71.5 - opens_px) / 12, 0.0, 1.0);
            const double ends = std::clamp((x - 55.5 - opens_px) / 12, 0.0, 1.0);
            EXPECT_NEAR(out.at(x, 16, 0) / box, ends - begins, 0.03) << phase << " " << x;
        }
    };
    expect_from("center", -6);
    expect_from("start", 0);
    expect_from("end", -12);
}

TEST(Decoupled, OnSuzanneIsNearHerRenderersShutter) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    const SuzanneInMotion suzanne(*folder);
    const auto measured = suzanne.through(kEffect, kSharpLens);
    EXPECT_GE(measured.changed_db, 30);
    EXPECT_GE(measured.all_db, 40.5);
}

// ---- both ----

constexpr const char* kInTurn =
    R"({"effect": "dof"}, {"effect": "motion_blur"}, {"effect": "decoupled", "in": {"color": "capture.color", "in_turn": "motion_blur.color"}})";

/// The truth at this size has 128 samples.
TEST(Decoupled, WhereLensAndShutterMeetIsNearerToTheTruthThanOneAfterTheOther) {
    const scene::Scene toys = scene::shipped_scene("toys");
    const scene::SceneRenderer renderer(toys, 240, 135, 2);
    const Capture capture = renderer.render_capture(4);
    const auto truth = [&](bool lens, bool shutter) {
        scene::TruthSettings settings;
        settings.kinds.lens = lens;
        settings.kinds.shutter = shutter;
        settings.samples = 128;
        return renderer.render_truth(4, settings);
    };
    const Image both = truth(true, true), lens = truth(true, false), shutter = truth(false, true);
    std::vector<bool> meet = changed_pixels(lens, both);
    const std::vector<bool> by_lens = changed_pixels(shutter, both), all(meet.size(), true);
    for (std::size_t i = 0; i < meet.size(); ++i) meet[i] = meet[i] && by_lens[i];
    ASSERT_GT(std::count(meet.begin(), meet.end(), true), 300);
    const auto picture = [&](const std::string& steps) {
        return LookRunner(R"({"aftershade": 1, "steps": [)" + steps + "]}", gpu::test_backend())
            .color(capture);
    };
    const auto db = [&](const Image& image) { return display_psnr_db_where(meet, both, image); };
    const Image apart = picture(R"({"effect": "dof"}, {"effect": "motion_blur"})"), mixed = picture(kInTurn);
    const double at_once = db(picture(R"({"effect": "decoupled"})"));
    fmt::print("toys, where lens and shutter meet: {:.2f} dB, dof and motion_blur {:.2f}, mixed {:.2f}\n",
               at_once, db(apart), db(mixed));
    EXPECT_GE(at_once, db(apart) + 0.5);
    EXPECT_GE(db(mixed), db(apart) + 0.5);
    // Over all pixels the two are alike: lens and shutter share few of them.
    EXPECT_GE(display_psnr_db_where(all, both, mixed), display_psnr_db_where(all, both, apart) - 0.1);
}

/// The pixels need not be square.
TEST(Decoupled, TakesThePictureInTurnBitForBitWhereNothingMoves) {
    Capture capture = near_box_before_focus();
    const std::string lens =
        fmt::format(R"("params": {{"focus_distance": {}, "f_number": 0.2}})", kApertureFocusM);
    const std::string in_turn = R"({"effect": "dof", )" + lens + R"(}, {"effect": "motion_blur"})";
    const std::string mixed =
        R"(, {"effect": "decoupled", "in": {"color": "capture.color", "in_turn": "motion_blur.color"}, )" +
        lens + "}";
    for (const float aspect : {1.0f, 2.0f}) {
        capture.header.pixel_aspect = aspect;
        const auto picture = [&](const std::string& steps) {
            return LookRunner(R"({"aftershade": 1, "steps": [)" + steps + "]}", gpu::test_backend())
                .color(capture);
        };
        expect_same_bits(picture(in_turn + mixed), picture(in_turn));
    }
}

// ---- readouts ----

TEST(Decoupled, CountsTheSamplesThatNoCapturedPixelReaches) {
    LookRunner runner(Lens{12, 96}.look(kEffect, R"("blades": 4)"), gpu::test_backend(),
                      {"decoupled.shares"});
    const FrameResult result = runner.run(near_box_before_focus());
    const Image& shares = result.taps.at("decoupled.shares");
    for (int y = 20; y < 28; ++y) {
        EXPECT_EQ(shares.at(5, y, 0), 0);
        EXPECT_EQ(shares.at(90, y, 0), 0);
        // At the box's edge half of the lens sees around it, on to what the picture hides.
        EXPECT_NEAR(shares.at(63, y, 0), 0.5, 0.1);
        for (int x = 0; x < 96; ++x) EXPECT_LE(shares.at(x, y, 1), 0.02) << x;
    }
}

TEST(Decoupled, GivesTheSameBitsOnBothSoftwareBackends) {
    expect_same_bits_on_both_backends(kEffect);
}

}  // namespace
}  // namespace aftershade::test::decoupled
