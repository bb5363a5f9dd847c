// Motion of a world at rest, against the renderer's, the camera's own geometry in double, and what must be 0.
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "framework/scene/scene_renderer.h"
#include "tests/backends.h"
#include "tests/camera_pose.h"
#include "tests/crop.h"
#include "tests/look_runner.h"
#include "tests/not_finite.h"
#include "tests/scene/scene_text.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::velocity_from_camera {
namespace {

constexpr int kWidth = 64, kHeight = 36;

class VelocityRunner {
public:
    explicit VelocityRunner(const std::string& step = "")
        : runner_(R"({"aftershade": 1, "steps": [{"effect": "velocity_from_camera")" + step + "}]}",
                  gpu::test_backend(), {"velocity_from_camera.velocity"}) {}
    Image run(const Capture& capture, bool begins_shot = false) {
        FrameInputs frame;
        frame.capture = &capture;
        frame.begins_shot = begins_shot;
        return runner_.run(frame).taps.at("velocity_from_camera.velocity");
    }

private:
    LookRunner runner_;
};

/// Everything at one depth, seen from `pose`.
Capture view_from(const CameraPose& pose, int frame, float depth_m) {
    Capture capture =
        make_capture({.width = kWidth, .height = kHeight, .background_depth_m = depth_m}, frame);
    set_pose(capture.header.camera, pose, kWidth, kHeight);
    return capture;
}

Image velocity_between(const CameraPose& before, const CameraPose& now, float depth_m) {
    VelocityRunner runner;
    runner.run(view_from(before, 1, depth_m));
    return runner.run(view_from(now, 2, depth_m));
}

/// The largest distance from what the two cameras say in double precision, px.
double error_px(const Image& velocity, const CameraPose& before, const CameraPose& now, double depth_m) {
    double worst = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const glm::dvec2 here(x + 0.5, y + 0.5);
            const glm::dvec4 point = now.world_at(here, depth_m, kWidth, kHeight);
            const glm::dvec2 expected = here - before.pixel_of(point, kWidth, kHeight);
            const glm::dvec2 got(velocity.at(x, y, 0), velocity.at(x, y, 1));
            worst = std::max(worst, glm::length(got - expected));
        }
    return worst;
}

bool is_zero(const Image& velocity) {
    for (const float value : velocity.floats())
        if (value != 0) return false;
    return true;
}

TEST(VelocityFromCamera, IsWhatTheRendererSaysOfASceneAtRest) {
    const scene::Scene hall = scene::shipped_scene("camera_checker");
    const scene::SceneRenderer renderer(hall, 160, 90, 2);
    VelocityRunner runner;
    runner.run(renderer.render_capture(5));
    const Capture capture = renderer.render_capture(6);
    const Image velocity = runner.run(capture);
    const Image& expected = capture.images.at("velocity");
    double longest = 0;
    int background = 0;
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 160; ++x) {
            background += std::isinf(capture.images.at("depth").at(x, y, 0));
            longest = std::max(longest, std::hypot(double(expected.at(x, y, 0)), expected.at(x, y, 1)));
            for (int c = 0; c < 2; ++c)
                ASSERT_NEAR(velocity.at(x, y, c), expected.at(x, y, c), 2e-4) << x << ", " << y;
        }
    EXPECT_GT(longest, 5);
    EXPECT_GT(background, 100);
}

TEST(VelocityFromCamera, FollowsEveryWayThatACameraMoves) {
    const CameraPose before{{0.1, 0, 0.2}, {1, -2, 3}, 36, 36};
    const CameraPose now{{-0.1, 0.15, -0.3}, {0, 2, -1}, 40, 36};
    for (const float depth_m : {0.7f, 5.0f, 1e5f, kInfinity})
        EXPECT_LT(error_px(velocity_between(before, now, depth_m), before, now, depth_m), 1e-4) << depth_m;
}

TEST(VelocityFromCamera, OfTheBackgroundIsTheCamerasTurningAlone) {
    const CameraPose before{{0, 0, 0}, {0, 0, 0}};
    const CameraPose walked{{2, 1, -3}, {0, 0, 0}};
    const Image at_rest = velocity_between(before, walked, kInfinity);
    for (const float value : at_rest.floats()) ASSERT_NEAR(value, 0, 1e-4);
    const CameraPose turned{{2, 1, -3}, {0, 3, 0}};
    // Panning left by 3 degrees moves what was in the middle of the picture to the right.
    const Image image = velocity_between(before, turned, kInfinity);
    EXPECT_NEAR(image.at(kWidth / 2, kHeight / 2, 0), 64 * std::tan(glm::radians(3.0)), 0.02);
}

TEST(VelocityFromCamera, KeepsItsPrecisionFarFromTheWorldsOrigin) {
    const glm::dvec3 far_m(3e6, -2e6, 5e5);
    const CameraPose before{far_m, {0, 30, 0}}, now{far_m + glm::dvec3(0.05, 0, 0.02), {0, 30.5, 0}};
    EXPECT_LT(error_px(velocity_between(before, now, 2), before, now, 2), 1e-3);
}

TEST(VelocityFromCamera, OfACameraAtRestIsExactlyZero) {
    const CameraPose pose{{12.3, -4.5, 6.7}, {8, 9, 10}};
    EXPECT_TRUE(is_zero(velocity_between(pose, pose, 3.3f)));
}

TEST(VelocityFromCamera, IsZeroOnTheFirstFrameAfterACutAndWithoutMatrices) {
    const CameraPose before, now{{0.5, 0, 0}, {0, 5, 0}};
    VelocityRunner runner;
    EXPECT_TRUE(is_zero(runner.run(view_from(before, 1, 3)))) << "first frame";
    EXPECT_FALSE(is_zero(runner.run(view_from(now, 2, 3))));
    EXPECT_TRUE(is_zero(runner.run(view_from(before, 3, 3), true))) << "cut";
    EXPECT_FALSE(is_zero(runner.run(view_from(now, 4, 3))));
    EXPECT_TRUE(is_zero(runner.run(view_from(before, 9, 3)))) << "gap";

    Capture unknown = view_from(before, 10, 3);
    unknown.header.camera.camera_from_world.reset();
    EXPECT_TRUE(is_zero(runner.run(unknown))) << "this frame's matrices";
    EXPECT_TRUE(is_zero(runner.run(view_from(now, 11, 3)))) << "those of the frame before";
}

TEST(VelocityFromCamera, IsFiniteForWhatTheCameraBeforeHadBesideOrBehindIt) {
    // Backwards by 2 m: what is nearer than that was behind the camera.
    const CameraPose before, now{{0, 0, 2}, {0, 0, 0}};
    EXPECT_TRUE(is_zero(velocity_between(before, now, 1)));
    for (const float depth_m : {2.0f, 2.0f + 1e-6f, 2.001f}) {
        const Image velocity = velocity_between(before, now, depth_m);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                ASSERT_LE(std::hypot(velocity.at(x, y, 0), velocity.at(x, y, 1)), 16384.1f) << depth_m;
    }
    const CameraPose turned{{0, 0, 0}, {0, 150, 0}};
    EXPECT_TRUE(is_zero(velocity_between(before, turned, kInfinity))) << "150 degrees in a frame";
}

TEST(VelocityFromCamera, IsOfThePlaceInThePixelThatJitterTook) {
    const CameraPose before{{0, 0, 0}, {0, 0, 4}}, now;
    VelocityRunner runner;
    runner.run(view_from(before, 1, 3));
    Capture capture = view_from(now, 2, 3);
    capture.header.camera.jitter_px = {0.25, -0.5};
    const Image velocity = runner.run(capture);
    const glm::dvec2 here(10.75, 20);
    const glm::dvec2 expected =
        here - before.pixel_of(now.world_at(here, 3, kWidth, kHeight), kWidth, kHeight);
    EXPECT_NEAR(velocity.at(10, 20, 0), expected.x, 1e-4);
    EXPECT_NEAR(velocity.at(10, 20, 1), expected.y, 1e-4);
}

TEST(VelocityFromCamera, OfAPartOfThePictureIsPartOfTheWholes) {
    const CameraPose before, now{{0.1, 0.2, 0}, {1, 2, 3}};
    const Window window{10, 7, 40, 30};
    VelocityRunner whole, part;
    whole.run(view_from(before, 1, 3));
    part.run(cropped(view_from(before, 1, 3), window));
    const Image a = whole.run(view_from(now, 2, 3)), b = part.run(cropped(view_from(now, 2, 3), window));
    for (int y = 0; y < b.height(); ++y)
        for (int x = 0; x < b.width(); ++x)
            for (int c = 0; c < 2; ++c) ASSERT_NEAR(b.at(x, y, c), a.at(x + 10, y + 7, c), 1e-4);
}

TEST(VelocityFromCamera, LeavesMaskedObjectsTheCapturesOwnMotion) {
    const CameraPose before, now{{0.1, 0, 0}, {0, 0, 0}};
    const auto capture = [](const CameraPose& pose, int frame) {
        Capture made = make_capture({.background_depth_m = 4,
                                     .box = SyntheticBox{.x = 10,
                                                         .y = 6,
                                                         .width = 12,
                                                         .height = 10,
                                                         .velocity_x = 3,
                                                         .velocity_y = -2,
                                                         .depth_m = 2}},
                                    frame);
        set_pose(made.header.camera, pose, kWidth, kHeight);
        return made;
    };
    VelocityRunner runner(R"(, "mask": {"object": [2], "invert": true})");
    runner.run(capture(before, 1));
    const Capture second = capture(now, 2);
    const Image velocity = runner.run(second);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool box = second.images.at("object_id").uint_at(x, y, 0) == 2;
            ASSERT_NEAR(velocity.at(x, y, 0), box ? 3 : -0.1 / 4 * 64, 1e-4) << x << ", " << y;
            ASSERT_NEAR(velocity.at(x, y, 1), box ? -2 : 0, 1e-4);
        }
}

}  // namespace
}  // namespace aftershade::test::velocity_from_camera
