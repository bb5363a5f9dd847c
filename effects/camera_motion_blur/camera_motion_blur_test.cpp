// A moving camera's blur against the renderer's shutter, closed forms of paths and coverage, and what must
// stay sharp.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "framework/compare/metrics.h"
#include "framework/image/role.h"
#include "framework/scene/scene_renderer.h"
#include "tests/backends.h"
#include "tests/camera_pose.h"
#include "tests/crop.h"
#include "tests/look_runner.h"
#include "tests/not_finite.h"
#include "tests/scene/scene_text.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::camera_motion_blur {
namespace {

constexpr int kWidth = 96, kHeight = 54;

std::string look_of(const std::string& params) {
    return R"({"aftershade": 1, "steps": [{"effect": "camera_motion_blur", "params": {)" + params + "}}]}";
}

/// What the second of two captures becomes.
Image blurred(const std::string& params, Capture before, Capture now) {
    before.header.frame = 1;
    now.header.frame = 2;
    LookRunner runner(look_of(params), gpu::test_backend());
    runner.color(before);
    return runner.color(now);
}

using Pattern = std::function<double(glm::dvec2 px)>;

/// Everything at one depth, with a pattern of grey.
Capture wall(const CameraPose& pose, float depth_m, const Pattern& pattern) {
    Capture capture = make_capture({.width = kWidth, .height = kHeight, .background_depth_m = depth_m});
    set_pose(capture.header.camera, pose, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3; ++c)
                capture.images["color"].at(x, y, c) = float(pattern({x + 0.5, y + 0.5}));
    return capture;
}

Image blurred_wall(const std::string& params, const CameraPose& before, const CameraPose& now, float depth_m,
                   const Pattern& pattern) {
    return blurred(params, wall(before, depth_m, pattern), wall(now, depth_m, pattern));
}

double waves(glm::dvec2 px) {
    return 0.5 + 0.25 * std::sin(px.x / 5 + 1) + 0.2 * std::cos(px.y / 4);
}

double step_at_48(glm::dvec2 px) {
    return px.x < 48 ? 0 : 1;
}

/// Sideways, so that what is at a depth of 3 m moves to the right by `px` a frame: the picture is 96 px wide
/// for a tangent of 1.
CameraPose before_moving_by(double px) {
    return {.position_m = {px / kWidth * 3, 0, 0}};
}

bool same(const Image& a, const Image& b) {
    return same_in_window(a, b, {0, 0, a.width() - 1, a.height() - 1});
}

/// PSNR of frame 6 of a scene, sharp and blurred; of a capture of one or of two layers.
std::pair<double, double> decibels(const scene::Scene& scene, const std::string& params, int layers = 1) {
    const scene::SceneRenderer renderer(scene, 480, 270, 2);
    scene::TruthSettings settings;
    settings.kinds.shutter = true;
    settings.samples = 64;
    const Image truth = renderer.render_truth(6, settings);
    LookRunner runner(look_of(params), gpu::test_backend());
    const auto capture_of = [&](int frame) {
        Capture capture = renderer.render_capture(frame);
        if (layers == 1) return capture;
        Capture behind = std::move(renderer.render_layers(frame, frame, {0, 0}, 2)[1]);
        for (const char* role : {"color", "depth"})
            capture.images[RoleId::of_layer(1, role)] = std::move(behind.images.at(role));
        return capture;
    };
    runner.color(capture_of(5));
    const Capture now = capture_of(6);
    return {display_psnr_db(truth, now.images.at("color")), display_psnr_db(truth, runner.color(now))};
}

TEST(CameraMotionBlur, ComesTo37DecibelsOfTheRenderersShutterInTheCheckeredHall) {
    const auto [sharp, blur] = decibels(scene::shipped_scene("camera_checker"), "");
    EXPECT_LT(sharp, 29);
    EXPECT_GT(blur, 37);
    const auto [again, simple] =
        decibels(scene::shipped_scene("camera_checker"), R"("occlusion": false, "samples": 8)");
    EXPECT_GT(simple, 32) << "as in 2008";
}

/// A post before a wall, and a camera that goes sideways past them.
constexpr const char* kPost =
    R"({ "aftershade": 1, "summary": "A test.", "frames": "1-12", "size": [480, 270],
  "camera": { "position": { "keys": { "0": [-1.8, 0, 3], "12": [1.8, 0, 3] } },
              "target": { "keys": { "0": [-1.8, 0, 0], "12": [1.8, 0, 0] } }, "focal_length": "28 mm" },
  "shutter": { "angle": 180 }, "ambient": 1,
  "materials": { "wall": { "albedo": { "checker": [[0.1, 0.3, 0.5], [0.8, 0.7, 0.6]], "cells": [12, 8] }, "specular": 0 },
                 "post": { "albedo": [0.9, 0.1, 0.1], "specular": 0 } },
  "objects": [ { "name": "wall", "shape": "plane", "size": [24, 12], "position": [0, 0, -4], "material": "wall" },
    { "name": "post", "shape": "box", "size": [0.3, 4, 0.1], "position": [-1.2, 0, 0.5], "material": "post",
      "repeat": { "count": [3, 1, 1], "step": [1.2, 0, 0] } } ] })";

TEST(CameraMotionBlur, WithOcclusionIsThreeDecibelsBetterWhereNearThingsPassBeforeFarOnes) {
    const scene::Scene scene = scene::scene_of(kPost);
    const double simple = decibels(scene, R"("occlusion": false)").second;
    EXPECT_GT(decibels(scene, "").second, simple + 3) << simple;
}

TEST(CameraMotionBlur, ShowsWhatTheSecondLayerHasOfTheUncovered) {
    std::string fine_checks = kPost;
    fine_checks.replace(fine_checks.find("[12, 8]"), 7,
                        "[150, 75]");  // nothing beside the post says what it hides
    const scene::Scene scene = scene::scene_of(fine_checks);
    const double known = decibels(scene, "", 2).second;
    EXPECT_GT(known, decibels(scene, "").second + 0.5) << known;
}

/// Floors seen at a grazing angle are not uncovered: what lies behind them must not show.
TEST(CameraMotionBlur, IsNotFartherFromTheShutterWithASecondLayer) {
    const scene::Scene hall = scene::shipped_scene("camera_checker");
    const double one = decibels(hall, "").second, two = decibels(hall, "", 2).second;
    EXPECT_GE(two, one - 0.05) << one;
}

/// A near strip before a wall, both of one light, where the strip has `share` of the pixels at its edges: the
/// layers say so, and the depth of the picture is the wall's.
Capture strip_before_wall(const CameraPose& pose, int left, int right, float share) {
    Capture capture = wall(pose, 6, [](glm::dvec2) { return 0.2; });
    for (int k = 0; k < 2; ++k) {
        capture.images[RoleId::of_layer(k, "color")] = Image(kWidth, kHeight, 4);
        capture.images[RoleId::of_layer(k, "depth")] = Image(kWidth, kHeight, 1);
    }
    const auto put = [&](int layer, int x, int y, float light, float alpha, float depth_m) {
        for (int c = 0; c < 3; ++c)
            capture.images[RoleId::of_layer(layer, "color")].at(x, y, c) = alpha * light;
        capture.images[RoleId::of_layer(layer, "color")].at(x, y, 3) = alpha;
        capture.images[RoleId::of_layer(layer, "depth")].at(x, y, 0) = depth_m;
    };
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool is_strip = x >= left && x <= right;
            const float alpha = x == left || x == right ? share : 1.0f;
            put(0, x, y, is_strip ? 0.9f : 0.2f, is_strip ? alpha : 1.0f, is_strip ? 3.0f : 6.0f);
            if (!is_strip) {
                put(1, x, y, 0, 0, std::numeric_limits<float>::infinity());
                continue;
            }
            put(1, x, y, 0.2f, 1, 6);
            const float light = 0.9f * alpha + 0.2f * (1 - alpha);
            for (int c = 0; c < 3; ++c) capture.images["color"].at(x, y, c) = light;
            if (alpha > 0.5f) capture.images["depth"].at(x, y, 0) = 3;
        }
    return capture;
}

TEST(CameraMotionBlur, MovesWhatHasTwoFifthsOfAPixelByTwoFifths) {
    const int left = 40, right = 54;
    const double speed_px = 16;
    const Image out = blurred(R"("samples": 64, "jitter": 0)",
                              strip_before_wall(before_moving_by(speed_px), left, right, 0.4f),
                              strip_before_wall({}, left, right, 0.4f));
    for (int x = 30; x < 66; ++x) {
        double covered = 0;
        for (int i = 0; i < 256; ++i) {
            const double shift = 0.5 * speed_px * ((i + 0.5) / 256 - 0.5);
            const double from = std::max(left + 0.6 + shift, double(x));
            covered += std::max(std::min(right + 0.4 + shift, x + 1.0) - from, 0.0) / 256;
        }
        EXPECT_NEAR(out.at(x, 27, 0), 0.2 + 0.7 * covered, 0.015) << x;  // measured 0.0105
    }
}

TEST(CameraMotionBlur, OfADepthAloneIsTheMeanAlongTheCamerasVelocity) {
    const CameraPose before = before_moving_by(13);
    const Image out = blurred_wall(R"("samples": 64)", before, {}, 3, waves);
    // Half the frame at 180 degrees: from 3.25 px before to 3.25 px after.
    for (int y = 2; y < kHeight - 2; ++y)
        for (int x = 8; x < kWidth - 8; ++x) {
            double expected = 0;
            for (int i = 0; i < 64; ++i)
                expected += waves({x + 0.5 + 6.5 * ((i + 0.5) / 64 - 0.5), y + 0.5}) / 64;
            ASSERT_NEAR(out.at(x, y, 0), expected, 0.006) << x << ", " << y;
        }
    // And velocity_from_camera says the same velocity.
    LookRunner runner(R"({"aftershade": 1, "steps": [{"effect": "velocity_from_camera"}]})",
                      gpu::test_backend());
    Capture first = wall(before, 3, waves), second = wall({}, 3, waves);
    second.header.frame = first.header.frame + 1;
    runner.run(first);
    const Image velocity = runner.run(second).images.at("velocity");
    for (int x = 0; x < kWidth; ++x) {
        ASSERT_NEAR(velocity.at(x, 20, 0), 13, 1e-4);
        ASSERT_NEAR(velocity.at(x, 20, 1), 0, 1e-4);
    }
}

TEST(CameraMotionBlur, OpensTheShutterWhenItsPhaseSays) {
    // What moves to the right by 16 px a frame has its edge, over half a frame, in these 8 px.
    const std::pair<const char*, int> edges[] = {{"start", 48}, {"center", 44}, {"end", 40}};
    for (const auto& [phase, first] : edges) {
        const Image out = blurred_wall(R"("jitter": 0, "shutter_phase": ")" + std::string(phase) + '"',
                                       before_moving_by(16), {}, 3, step_at_48);
        for (int x = 20; x < 76; ++x) {
            const double expected = std::clamp((x + 0.5 - first) / 8, 0.0, 1.0);
            ASSERT_NEAR(out.at(x, 20, 0), expected, 0.07) << phase << " " << x;
        }
    }
}

/// The mean over the exposure of what a pattern shows at infinity where the cameras between `before` and now
/// (t = 0) look; `pose_at` is the truth of how they move. `exposure` is in frames.
double mean_at(glm::dvec2 px, const Pattern& pattern, const std::function<CameraPose(double)>& pose_at,
               double exposure) {
    double sum = 0;
    for (int i = 0; i < 64; ++i) {
        const CameraPose pose = pose_at(exposure * ((i + 0.5) / 64 - 0.5));
        const glm::dvec4 direction = pose.world_at(px, double(kInfinity), kWidth, kHeight);
        sum += pattern(pose_at(0).pixel_of(direction, kWidth, kHeight)) / 64;
    }
    return sum;
}

TEST(CameraMotionBlur, FollowsArcsOfARollWhereAStraightPathWouldBeWrong) {
    const auto pose_at = [](double t) { return CameraPose{.angles_deg = {0, 0, 60 * t}}; };
    const Image out = blurred_wall(R"("samples": 128, "jitter": 0, "shutter_angle": 360)", pose_at(-1),
                                   pose_at(0), kInfinity, waves);
    double straight_is_wrong_by = 0;
    for (int y = 16; y < kHeight - 16; ++y)
        for (int x = 24; x < kWidth - 24; ++x) {
            const glm::dvec2 px(x + 0.5, y + 0.5), from_middle = px - glm::dvec2(kWidth, kHeight) * 0.5;
            const double expected = mean_at(px, waves, pose_at, 1);
            ASSERT_NEAR(out.at(x, y, 0), expected, 0.01) << x << ", " << y;
            double straight = 0;
            for (int i = 0; i < 64; ++i) {
                const double angle = glm::radians(60 * ((i + 0.5) / 64 - 0.5));
                straight += waves(px + angle * glm::dvec2(-from_middle.y, from_middle.x)) / 64;
            }
            straight_is_wrong_by = std::max(straight_is_wrong_by, std::abs(straight - expected));
        }
    EXPECT_GT(straight_is_wrong_by, 0.03);
}

TEST(CameraMotionBlur, OfTheBackgroundKnowsTurningAndZoomButNoWalking) {
    const auto pose_at = [](double t) {
        // A zoom's lines of sight are mixed, that is 1 / focal length.
        return CameraPose{.angles_deg = {0, 8 * t, 0}, .focal_length_mm = 1 / ((1 + t) / 40 - t / 32)};
    };
    CameraPose before = pose_at(-1);
    before.position_m = {3, -2, 1};
    const Image out = blurred_wall(R"("samples": 128, "jitter": 0)", before, pose_at(0), kInfinity, waves);
    for (int y = 8; y < kHeight - 8; ++y)
        for (int x = 12; x < kWidth - 12; ++x)
            ASSERT_NEAR(out.at(x, y, 0), mean_at({x + 0.5, y + 0.5}, waves, pose_at, 0.5), 0.012)
                << x << ", " << y;
}

/// A white box at 3 m before black at 30 m, whose right edge is at x = 48.
Capture box_before_wall(const CameraPose& pose) {
    Capture capture = make_capture(
        {.width = kWidth,
         .height = kHeight,
         .background_depth_m = 30,
         .box =
             SyntheticBox{.x = 28, .y = 0, .width = 20, .height = kHeight, .depth_m = 3, .color = {1, 1, 1}}},
        0);
    set_pose(capture.header.camera, pose, kWidth, kHeight);
    return capture;
}

TEST(CameraMotionBlur, SpreadsANearEdgeOverBothSidesByItsCoverageInTime) {
    const Image out = blurred(R"("samples": 32, "shutter_angle": 360)", box_before_wall(before_moving_by(16)),
                              box_before_wall({}));
    for (int x = 0; x < kWidth; ++x) {
        // The box passes from 8 px to the left to 8 px to the right.
        const double left = std::clamp((x + 0.5 - 20) / 16, 0.0, 1.0);
        const double right = std::clamp((56 - (x + 0.5)) / 16, 0.0, 1.0);
        ASSERT_NEAR(out.at(x, 30, 0), std::min(left, right), 0.07) << x;
    }
}

TEST(CameraMotionBlur, CutsPathsToMaxBlur) {
    const Image out = blurred_wall(R"("max_blur": 20, "shutter_angle": 360, "samples": 40, "jitter": 0)",
                                   before_moving_by(300), {}, 3, step_at_48);
    for (int x = 20; x < 76; ++x)
        ASSERT_NEAR(out.at(x, 20, 0), std::clamp((x + 0.5 - 38) / 20, 0.0, 1.0), 0.06) << x;
}

TEST(CameraMotionBlur, LeavesThePictureAloneBitForBitWhereNothingMovesOrTheShutterStaysShut) {
    const CameraPose pose{{3, 4, 5}, {6, 7, 8}};
    const Capture still = wall(pose, 3, waves);
    EXPECT_TRUE(same(still.images.at("color"), blurred("", still, still)));
    EXPECT_TRUE(same(still.images.at("color"), blurred(R"("shutter_angle": 0)", wall({}, 3, waves), still)));
    EXPECT_TRUE(same(still.images.at("color"), blurred(R"("max_blur": 0)", wall({}, 3, waves), still)));
    EXPECT_FALSE(same(still.images.at("color"), blurred("", wall({}, 3, waves), still)));
}

TEST(CameraMotionBlur, LeavesThePictureAloneWhereTheMotionIsNotKnown) {
    Capture first = wall({}, 3, waves), second = wall(before_moving_by(9), 3, waves);
    LookRunner runner(look_of(""), gpu::test_backend());
    EXPECT_TRUE(same(first.images.at("color"), runner.color(first))) << "first frame";
    second.header.frame = first.header.frame + 1;
    FrameInputs cut;
    cut.capture = &second;
    cut.begins_shot = true;
    EXPECT_TRUE(same(second.images.at("color"), runner.run(cut).images.at("color"))) << "cut";
    second.header.camera.ndc_from_world.reset();
    EXPECT_TRUE(same(second.images.at("color"), blurred("", first, second))) << "no matrices";
}

TEST(CameraMotionBlur, NeitherBlursNorGathersObjectsThatAreFixedToTheCamera) {
    const auto capture = [](const CameraPose& pose) {
        Capture made = make_capture({.width = kWidth,
                                     .height = kHeight,
                                     .background = {0.5f, 0.25f, 0.1f},
                                     .background_depth_m = 3,
                                     .box = SyntheticBox{.x = 40,
                                                         .y = 20,
                                                         .width = 9,
                                                         .height = 12,
                                                         .depth_m = 0.5f,
                                                         .color = {1e4f, 1e4f, 1e4f}}},
                                    0);
        set_pose(made.header.camera, pose, kWidth, kHeight);
        return made;
    };
    const std::string fixed = R"("objects": {"rows": [{"object": 2, "blurs": false}]})";
    const CameraPose before{{0.3, 0.1, 0.2}, {0, 2, 3}};
    for (const std::string occlusion : {"true", "false"}) {
        const Image out = blurred(fixed + R"(, "occlusion": )" + occlusion, capture(before), capture({}));
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const bool box = x >= 40 && x < 49 && y >= 20 && y < 32;
                ASSERT_NEAR(out.at(x, y, 0), box ? 1e4f : 0.5f, box ? 0 : 1e-6) << x << ", " << y;
            }
        EXPECT_GT(blurred(R"("occlusion": )" + occlusion, capture(before), capture({})).at(39, 26, 0), 1)
            << "without the table it does, occlusion " << occlusion;
    }
}

TEST(CameraMotionBlur, IsFiniteWhateverTheCameraDoes) {
    const CameraPose wild[] = {{{0, 0, 5}, {}},    {{0, 0, -5}, {}},   {{}, {0, 170, 0}},
                               {{1e5, 0, 0}, {}},  {{}, {90, 90, 90}}, {{0, 0, 3}, {0, 0, 180}},
                               {{}, {}, 5000, 36}, {{1e-9, 0, 0}, {}}, {{}, {0, 1e-7, 0}}};
    for (const CameraPose& before : wild)
        for (const float depth_m : {1e-3f, 3.0f, 1e9f, kInfinity})
            for (const std::string occlusion : {"true", "false"}) {
                const Image out =
                    blurred_wall(R"("shutter_angle": 720, "max_blur": 512, "occlusion": )" + occlusion,
                                 before, {}, depth_m, waves);
                for (const float value : out.floats()) ASSERT_TRUE(value >= 0 && value <= 1.001f) << depth_m;
            }
}

TEST(CameraMotionBlur, OfAPartOfThePictureIsTheWholesAwayFromItsEdges) {
    const Window window{16, 8, 79, 45};
    const CameraPose before = before_moving_by(40);
    Capture first = wall(before, 3, waves), second = wall({}, 3, waves);
    for (const std::string params : {R"("samples": 8)", R"("samples": 8, "occlusion": false)"}) {
        const Image whole = blurred(params, first, second);
        const Image part = blurred(params, cropped(first, window), cropped(second, window));
        for (int y = 0; y < part.height(); ++y)
            for (int x = 12; x < part.width() - 12; ++x)
                ASSERT_NEAR(part.at(x, y, 0), whole.at(x + 16, y + 8, 0), 0.015) << x << ", " << y;
    }
}

}  // namespace
}  // namespace aftershade::test::camera_motion_blur
