// What motion_blur makes of light that dof has spread in front of other surfaces: against closed forms.
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "effects/dof/dof_bars.h"
#include "effects/motion_blur/motion_blur_test.h"

namespace aftershade::test::motion_blur {
namespace {

constexpr int kWidth = 160, kHeight = 64, kLeft = 66, kRight = 94;
constexpr double kRadiusPx = 12, kWayPx = 12;  // of the lens's disk; while the shutter is open
constexpr float kBarLight = 0.9f;

double opacity(double x) {
    return dof::disk_left_of((kRight - x) / kRadiusPx) - dof::disk_left_of((kLeft - x) / kRadiusPx);
}

double mean_of_exposure(double longest_way_px, const std::function<double(double way_px)>& at) {
    constexpr int times = 256;
    double sum = 0;
    for (int i = 0; i < times; ++i) sum += at(longest_way_px * ((i + 0.5) / times - 0.5));
    return sum / times;
}

/// A near bar, out of focus, before a wall in focus.
Capture bar_before_wall(const std::function<double(double x)>& wall, bool is_bar_moving,
                        double way_px = kWayPx) {
    Capture capture =
        make_capture({.width = kWidth, .height = kHeight, .background_depth_m = kApertureFocusM});
    each_pixel(capture.images["color"], [&](int x, int y) {
        const bool is_bar = x >= kLeft && x < kRight;
        for (int c = 0; c < 3; ++c)
            capture.images["color"].at(x, y, c) = is_bar ? kBarLight : float(wall(x + 0.5));
        set_velocity(capture, x, y, is_bar == is_bar_moving ? float(way_px / kExposure) : 0, 0);
        if (!is_bar) return;
        capture.images["depth"].at(x, y, 0) = kApertureNearM;
        capture.images["object_id"].uint_at(x, y, 0) = 2;
    });
    return capture;
}

Image through_lens_and_shutter(const Capture& capture, const std::string& of_lens = "") {
    const std::string look = fmt::format(
        R"({{"aftershade": 1, "steps": [{{"effect": "dof"{}, "params": {{{}, "blades": 0}}}}, {{"effect": "motion_blur"}}]}})",
        of_lens, Lens{kRadiusPx, kWidth}.params());
    return LookRunner(look, gpu::test_backend()).color(capture);
}

struct Errors {
    double mean = 0, largest = 0;
};

/// Differences from columns of a closed form, in those where no picture border shows.
Errors errors_of(const Image& out, const std::function<double(double x)>& expected) {
    Errors errors;
    for (int x = 30; x < kWidth - 30; ++x) {
        const double error = std::abs(out.at(x, kHeight / 2, 0) - expected(x + 0.5));
        errors.mean += error / (kWidth - 60);
        errors.largest = std::max(errors.largest, error);
    }
    return errors;
}

double stripes(double x) {
    return x - 40 * std::floor(x / 40) < 20 ? 0.5 : 0.2;
}

TEST(MotionBlurBehindALens, ABlurredBarAtRestStaysWhereItIsBeforeAWallThatMoves) {
    const Image out = through_lens_and_shutter(bar_before_wall(stripes, false));
    const Errors errors = errors_of(out, [](double x) {
        const double wall = mean_of_exposure(kWayPx, [&](double way_px) { return stripes(x - way_px); });
        return opacity(x) * kBarLight + (1 - opacity(x)) * wall;
    });
    EXPECT_LT(errors.mean, 0.002);
}

TEST(MotionBlurBehindALens, ABlurredBarMovesAsAWholeBeforeAWallAtRest) {
    constexpr double wall = 0.25;
    for (const double longest_way_px : {5.0, 12.0, 40.0}) {
        const Image out =
            through_lens_and_shutter(bar_before_wall([](double) { return wall; }, true, longest_way_px));
        const Errors errors = errors_of(out, [&](double x) {
            const double share =
                mean_of_exposure(longest_way_px, [&](double way_px) { return opacity(x - way_px); });
            return share * kBarLight + (1 - share) * wall;
        });
        EXPECT_LT(errors.mean, 0.003) << longest_way_px;
        EXPECT_LT(errors.largest, 0.02) << longest_way_px;
    }
}

TEST(MotionBlurBehindALens, ALampAtRestKeepsItsDiscBeforeAWallThatMoves) {
    const auto picture = [](bool has_lamp, float speed_px) {
        Capture capture = make_capture({.width = kWidth,
                                        .height = kHeight,
                                        .background = {0.3f, 0.3f, 0.3f},
                                        .background_depth_m = kApertureFocusM});
        each_pixel(capture.images["color"], [&](int x, int y) { set_velocity(capture, x, y, speed_px, 0); });
        if (has_lamp) {
            for (int c = 0; c < 3; ++c) capture.images["color"].at(80, 32, c) = 200;
            capture.images["depth"].at(80, 32, 0) = kApertureNearM;
            set_velocity(capture, 80, 32, 0, 0);
        }
        return through_lens_and_shutter(capture);
    };
    EXPECT_LT(largest_difference(picture(true, 24), picture(true, 0)), 0.04);
    EXPECT_GT(largest_difference(picture(true, 0), picture(false, 0)), 0.3);
}

/// A look may wire `foreground` past a step that darkens the picture.
TEST(MotionBlurBehindALens, AddsNoLightThatALaterStepHasTakenAway) {
    const std::string look = fmt::format(
        R"({{"aftershade": 1, "steps": [{{"effect": "dof", "params": {{{}, "blades": 0}}}},
             {{"effect": "color_grade", "params": {{"exposure": -3}}}},
             {{"effect": "motion_blur",
               "in": {{"foreground": "dof.foreground", "foreground_place": "dof.foreground_place"}}}}]}})",
        Lens{kRadiusPx, kWidth}.params());
    const Image out = LookRunner(look, gpu::test_backend()).color(bar_before_wall(stripes, false));
    each_pixel(out, [&](int x, int y) {
        ASSERT_GE(out.at(x, y, 0), 0) << x;
        ASSERT_LE(out.at(x, y, 0), kBarLight / 8 + 1e-3) << x;
    });
}

TEST(MotionBlurBehindALens, TakesNothingFromALensThatIsMixedInByNothing) {
    const Capture capture = bar_before_wall(stripes, false);
    EXPECT_EQ(largest_difference(through_lens_and_shutter(capture, R"(, "mix": 0)"), blur(capture)), 0);
}

}  // namespace
}  // namespace aftershade::test::motion_blur
