// What dof must do, against closed forms and against a renderer's own lens.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/aperture_checks.h"
#include "tests/backends.h"
#include "tests/not_finite.h"

namespace aftershade::test::dof {
namespace {

constexpr float kFocusM = kApertureFocusM;

const std::string kEffect = "dof";

Image blur(const Capture& capture, double radius_px, const std::string& more = "") {
    return through_aperture(kEffect, capture, radius_px, more);
}

/// A 3 x 3 px light in the middle of a square picture whose every pixel has the CoC radius of the lens.
Capture light_of_nine(int size, bool is_near, float intensity) {
    SyntheticScene scene{
        .width = size, .height = size, .background_depth_m = is_near ? kFocusM / 2 : kInfinity};
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) scene.points.push_back({size / 2 + x, size / 2 + y, intensity});
    return make_capture(scene);
}

// ---- the shape of a light ----

struct ShapeCase {
    int blades;
    double radius_px;
    double rotation_deg;
    bool is_near;
    const char* highlights;
    double least_iou;
};

void PrintTo(const ShapeCase& c, std::ostream* out) {
    *out << c.blades << " blades R " << c.radius_px << " rotation " << c.rotation_deg
         << (c.is_near ? " near " : " far ") << c.highlights;
}

class DofShape : public testing::TestWithParam<ShapeCase> {};

TEST_P(DofShape, OfALightOfThreePixelsIsTheAperturesWithAllItsEnergy) {
    const ShapeCase& c = GetParam();
    const int size = 96, center = size / 2;
    const float intensity = 1000;
    const std::string params = fmt::format(R"("blades": {}, "rotation": {}, "highlights": "{}")", c.blades,
                                           c.rotation_deg, c.highlights);
    const Image blurred = blur(light_of_nine(size, c.is_near, intensity), c.radius_px, params);
    const int sides = c.blades == 0 ? 64 : c.blades;  // 64 corners are a disk to 0.2 % of its area
    const Image expected = coverage_of_light(
        regular_polygon(sides, c.radius_px, c.rotation_deg + (c.is_near ? 180 : 0)), size, center, 3);
    const double iou = shape_iou(blurred, blurred.at(center, center, 0), expected);
    const double energy = sum_of(blurred) / (9.0 * intensity);
    RecordProperty("iou", fmt::format("{:.4f}", iou));
    RecordProperty("energy", fmt::format("{:.4f}", energy));
    EXPECT_GE(iou, c.least_iou);
    EXPECT_NEAR(energy, 1, 0.01);
}

/// The left column of a light of 3 px is half covered, as antialiasing has it: the light begins in the middle
/// of that column.
TEST(DofShape, OfALightWithAnAntialiasedRimBeginsWithinTheRimsPixels) {
    constexpr int size = 96, center = size / 2;
    constexpr float intensity = 1000, covered = 0.5f;
    Capture capture = light_of_nine(size, false, intensity);
    for (int y = center - 1; y <= center + 1; ++y)
        for (int c = 0; c < 3; ++c) capture.images["color"].at(center - 1, y, c) = covered * intensity;
    const Image out = blur(capture, 16);
    double sum = 0, moment = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            sum += double(out.at(x, y, 0));
            moment += (x + 0.5) * double(out.at(x, y, 0));
        }
    const double left = center - covered, right = center + 2;
    EXPECT_NEAR(moment / sum, 0.5 * (left + right), 0.01);
    EXPECT_NEAR(sum / (7.5 * double(intensity)), 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(
    Scattered, DofShape,
    testing::Values(ShapeCase{6, 24, 0, false, "scatter", 0.93}, ShapeCase{6, 24, 10, true, "scatter", 0.93},
                    ShapeCase{3, 24, 0, false, "scatter", 0.93}, ShapeCase{3, 24, 0, true, "scatter", 0.93},
                    ShapeCase{5, 16, 0, false, "scatter", 0.93}, ShapeCase{5, 16, 0, true, "scatter", 0.93},
                    ShapeCase{7, 12, 20, true, "scatter", 0.93}, ShapeCase{0, 20, 0, false, "scatter", 0.93},
                    ShapeCase{6, 8, 0, false, "scatter", 0.93}, ShapeCase{6, 4, 0, true, "scatter", 0.93}));
INSTANTIATE_TEST_SUITE_P(Gathered, DofShape,
                         testing::Values(ShapeCase{6, 24, 0, false, "gather", 0.93},
                                         ShapeCase{5, 16, 0, true, "gather", 0.93},
                                         ShapeCase{0, 12, 0, false, "gather", 0.93},
                                         ShapeCase{6, 6, 0, true, "gather", 0.93},
                                         ShapeCase{6, 4, 0, false, "gather", 0.93}));

TEST(DofShapeOf, BladesBentAllTheWayIsADisk) {
    const Capture light = light_of_nine(96, false, 1000);
    const Image disk = blur(light, 20, R"("blades": 0)"),
                bent = blur(light, 20, R"("blades": 5, "curvature": 1)");
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) ASSERT_NEAR(bent.at(x, y, 0), disk.at(x, y, 0), 1e-3) << x << " " << y;
}

TEST(DofShapeOf, BladesBentHalfWayLiesBetween) {
    const Capture light = light_of_nine(96, false, 1000);
    const auto pixels = [&](const char* params) {
        const Image image = blur(light, 24, params);
        int count = 0;
        for (int i = 0; i < 96 * 96; ++i) count += image.at(i % 96, i / 96, 0) > 0.5f * image.at(48, 48, 0);
        return count;
    };
    const int straight = pixels(R"("blades": 5)"), half = pixels(R"("blades": 5, "curvature": 0.5)"),
              disk = pixels(R"("blades": 0)");
    EXPECT_GT(half, straight + 50);
    EXPECT_LT(half, disk - 50);
}

TEST(DofShapeOf, ALightAtTheCornerIsCutByTheRimOfTheLensAndKeepsItsEnergy) {
    const int size = 160, at = 130;
    const double radius_px = 20, cat_eye = 0.6;
    SyntheticScene scene{.width = size, .height = size, .points = {{at, at, 1000}}};
    const Image cut = blur(make_capture(scene), radius_px, R"("blades": 0, "cat_eye": 0.6)");
    EXPECT_NEAR(sum_of(cut) / 1000, 1, 0.02);
    // The rim's middle lies from the light towards the picture's middle, in radii: cat_eye at the corner.
    const double shift = cat_eye * (size / 2.0 - (at + 0.5)) / (size / 2.0 * std::sqrt(2.0));
    Image expected(size, size, 1);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double dx = (x - at) / radius_px, dy = (y - at) / radius_px;
            expected.at(x, y, 0) =
                std::hypot(dx, dy) <= 1 && std::hypot(dx - shift, dy - shift) <= 1 ? 1.0f : 0.0f;
        }
    EXPECT_GE(shape_iou(cut, cut.at(at - 3, at - 3, 0), expected), 0.95);
}

// ---- what must not change ----

class DofSettings : public testing::TestWithParam<const char*> {};

TEST_P(DofSettings, LeaveAUniformImageUnchanged) {
    // Odd, for the coarser levels; sums of up to five thousand taps.
    expect_uniform_stays_uniform(
        kEffect, GetParam(),
        {.width = 95, .height = 63, .radius_px = 20, .tolerance = 1e-4, .alpha_tolerance = 1e-3});
}

INSTANTIATE_TEST_SUITE_P(All, DofSettings,
                         testing::Values(R"("blades": 6)", R"("blades": 0, "cat_eye": 0.5)",
                                         R"("blades": 7, "curvature": 0.3, "rotation": 17)",
                                         R"("quality": "fast")", R"("quality": "exact")",
                                         R"("highlights": "gather")"));

/// Its disc is wider than the surroundings that its brightness is compared with.
TEST(Dof, ALampKeepsItsLightInADiscOfAnySize) {
    for (const auto& [size, radius_px] : {std::pair(64, 20.0), {341, 150.0}}) {
        Capture capture = make_capture({.width = size,
                                        .height = size,
                                        .background_depth_m = kApertureFocusM,
                                        .points = {{size / 2, size / 2, kPointIntensity}}});
        capture.images["depth"].at(size / 2, size / 2, 0) = kApertureNearM;
        const Image out =
            through_aperture("dof", capture, radius_px, R"("blades": 0, "max_coc_radius": 256)");
        EXPECT_NEAR(sum_of(out) / kPointIntensity, 1, 0.03) << radius_px;
    }
}

TEST(Dof, CopiesPixelsInFocusBitForBit) {
    expect_picture_in_focus_is_copied(kEffect, 1.0f);
}

TEST(Dof, KeepsAFocusedObjectOutOfTheBlurBehindIt) {
    const Image out = blur(aperture_box(kFocusM, 9), 12);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) {
            if (is_in_aperture_box(x, y)) ASSERT_EQ(out.at(x, y, 0), 9) << x << " " << y;
            else ASSERT_LE(out.at(x, y, 0), 0.001f * 9) << x << " " << y;
        }
}

/// The silhouette of a near object, straight from top to bottom, is a ramp as wide as the aperture, and what
/// it hides shows through on both sides: the closed form is the aperture's part on one side of a line.
TEST(Dof, MakesANearSilhouetteTheRampOfItsAperture) {
    const double radius_px = 12;
    const SyntheticBox box{
        .x = 40, .y = -10, .width = 80, .height = 100, .depth_m = kFocusM / 2, .color = {1, 1, 1}};
    const Capture capture = make_capture(
        {.width = 96, .height = 64, .background = {0, 0, 4}, .background_depth_m = kFocusM, .box = box}, 0);
    const Image out = blur(capture, radius_px, R"("blades": 0)");
    for (int x = 20; x < 60; ++x) {
        const double t = std::clamp((x + 0.5 - 40) / radius_px, -1.0, 1.0);
        const double share = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / 3.14159265358979;
        EXPECT_NEAR(out.at(x, 32, 0), share, 0.03) << x;
        EXPECT_NEAR(out.at(x, 32, 2), share + 4 * (1 - share), 0.09) << x;
    }
}

TEST(Dof, BlursAlphaWithTheColorThatItCovers) {
    expect_alpha_blurs_with_color(kEffect, 2e-3f);
}

/// An overscan capture's data window is larger than what is displayed, so a light out of sight can reach into
/// it.
TEST(Dof, ShowsTheBlurOfALightInTheOverscan) {
    Capture capture = make_capture({.width = 96, .height = 48, .points = {{4, 24, 1000}}});
    capture.header.display_window = {8, 0, 95, 47};
    const Image out = LookRunner(Lens{12, 88}.look("dof"), gpu::test_backend()).color(capture);
    EXPECT_NEAR(out.at(10, 24, 0), 1000 / (2.598 * 12 * 12), 0.1);
}

TEST(Dof, LeavesNothingOfAFrameInTheNextOne) {
    const auto box_at = [](int x, float depth_m) {
        SyntheticScene scene{
            .width = 200, .height = 120, .background = {0.2f, 0.3f, 0.4f}, .background_depth_m = kFocusM};
        scene.box = SyntheticBox{.x = x, .y = 30, .width = 40, .height = 50, .depth_m = depth_m};
        scene.points = {{x + 9, 45, 300}, {150, 100, 20}};
        return make_capture(scene);
    };
    for (const std::string more :
         {"", R"("quality": "fast")", R"("background": "neighbours", "highlights": "gather")"}) {
        const std::string look = Lens{20, 200}.look("dof", more);
        LookRunner runner(look, gpu::test_backend());
        for (const Capture& capture : {box_at(20, kFocusM / 2), box_at(130, kFocusM / 2),
                                       box_at(60, kInfinity), box_at(60, kFocusM), box_at(10, kFocusM / 2)}) {
            const Image shown = runner.color(capture),
                        first = LookRunner(look, gpu::test_backend()).color(capture);
            ASSERT_TRUE(std::ranges::equal(shown.floats(), first.floats())) << more;
        }
    }
}

TEST(Dof, GivesTheSameBitsOnBothSoftwareBackends) {
    expect_same_bits_on_both_backends(kEffect, R"("blades": 5, "rotation": 7, "cat_eye": 0.3)",
                                      aperture_random_lights(1));
}

// ---- where the focus is ----

/// A lens of a wanted focus: any form of value that a look takes.
std::string focused_at(const std::string& focus) {
    return R"({"aftershade": 1, "steps": [{"effect": "dof", "params": {"f_number": 0.5, "focus_distance": )" +
           focus + "}}]}";
}

TEST(DofFocus, IsTheSameByANumberADepthAnObjectTheCameraOrAKey) {
    const SyntheticBox box{.x = 40, .y = 10, .width = 30, .height = 28, .depth_m = 1.5f, .color = {1, 2, 3}};
    Capture capture = make_capture(
        {.width = 96, .height = 48, .background = {1, 0, 0}, .background_depth_m = 4, .box = box}, 2);
    capture.header.camera.set("focus_distance", 1.5);
    const auto picture = [&](const std::string& look) {
        return LookRunner(look, gpu::test_backend()).color(capture);
    };
    const Image expected = picture(focused_at("1.5"));
    for (const char* focus :
         {R"("150 cm")", R"({"from": "depth", "uv": [0.5, 0.5]})", R"({"from": "depth", "object": 2})",
          R"({"from": "camera.focus_distance"})", R"({"keys": {"1": 1, "3": 2}})"}) {
        const Image image = picture(focused_at(focus));
        EXPECT_TRUE(std::equal(expected.floats().begin(), expected.floats().end(), image.floats().begin()))
            << focus;
    }
    const Image elsewhere = picture(focused_at("4"));
    EXPECT_FALSE(std::equal(expected.floats().begin(), expected.floats().end(), elsewhere.floats().begin()));
}

// ---- CoC by tiles ----

/// Left half in focus, with an edge of less than a pixel; on the right a slope, something in front, and a
/// light at its edge beside which a pixel has some of its light but the depth of the slope.
Capture in_focus_in_part(int width, int height) {
    Capture capture = make_capture({.width = width, .height = height, .background_depth_m = kFocusM});
    Image& depth = capture.images.at("depth");
    Image& color = capture.images.at("color");
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            color.at(x, y, 0) = 0.1f * float((x * 7 + y * 3) % 11);
            if (x < width / 2) depth.at(x, y, 0) = x < 40 ? kFocusM * 0.97f : kFocusM * 1.03f;
            else if (x > width * 3 / 4) depth.at(x, y, 0) = y > height / 2 ? kInfinity : kFocusM * 0.6f;
            else depth.at(x, y, 0) = kFocusM + 0.02f * float(x - width / 2);
        }
    for (int c = 0; c < 3; ++c) {
        color.at(width * 3 / 4 + 1, height / 3, c) = 900;
        color.at(width * 3 / 4, height / 3, c) = 450;
    }
    return capture;
}

/// The module's textures, which a tap asks for, against those that the effect makes of some tiles alone.
TEST(DofTiles, HaveTheModulesCocWhereABlurTakesLight) {
    const Capture capture = in_focus_in_part(320, 100);
    for (const bool repairs : {true, false}) {
        std::vector<std::string> taps = {"dof.coc", "dof.lit_coc", "dof.lit", "dof.tile_step"};
        if (repairs) taps.emplace_back("dof.coc_step");
        LookRunner runner(Lens{12, 320}.look(kEffect, repairs ? "" : R"("highlight_repair": false)"),
                          gpu::test_backend(), taps);
        FrameResult result = runner.run(capture);
        const Image &coc = result.taps.at("dof.coc"), &lit_coc = result.taps.at("dof.lit_coc"),
                    &lit = result.taps.at("dof.lit"), &steps = result.taps.at("dof.tile_step");
        int left_out = 0, repaired = 0;
        for (int y = 0; y < 100; ++y)
            for (int x = 0; x < 320; ++x) {
                const bool is_made = lit_coc.at(x, y, 0) == coc.at(x, y, 0);
                if (lit.at(x / 16, y / 16, 0) > 0.5f) ASSERT_TRUE(is_made) << x << ", " << y;
                else left_out += !is_made && lit_coc.at(x, y, 0) == 0;
                const double depth_m = capture.images.at("depth").at(x, y, 0);
                repaired += std::abs(coc.at(x, y, 0) - 12 * (1 - kFocusM / depth_m)) > 1;
            }
        EXPECT_GT(left_out, 320 * 100 / 4) << repairs;
        EXPECT_EQ(repaired > 0, repairs);
        for (int ty = 0; ty < steps.height(); ++ty)
            for (int tx = 0; tx < steps.width(); ++tx) {
                float smallest = kInfinity, largest = -kInfinity;
                for (int y = 16 * ty; y < std::min(16 * ty + 16, 100); ++y)
                    for (int x = 16 * tx; x < 16 * tx + 16; ++x) {
                        const double depth_m = capture.images.at("depth").at(x, y, 0);
                        smallest = std::min(smallest, float(12 * (1 - kFocusM / depth_m)));
                        largest = std::max(largest, float(12 * (1 - kFocusM / depth_m)));
                    }
                EXPECT_NEAR(steps.at(tx, ty, 2), smallest, 1e-4) << tx << ", " << ty;
                EXPECT_NEAR(steps.at(tx, ty, 3), largest, 1e-4) << tx << ", " << ty;
                for (int c = 0; repairs && c < 4; ++c)
                    EXPECT_EQ(steps.at(tx, ty, c), result.taps.at("dof.coc_step").at(tx, ty, c))
                        << tx << ", " << ty;
            }
    }
}

// ---- against a renderer's lens ----

/// The sharp input has 21.7 dB.
TEST(DofOnSuzanne, ComesCloseToTheRenderersLens) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    const auto db = [&](const std::string& quality) {
        return suzanne_through_aperture_db(kEffect, *folder, R"("quality": ")" + quality + "\"");
    };
    const double fast_db = db("fast"), normal_db = db("normal"), exact_db = db("exact");
    EXPECT_GE(fast_db, 32.8);    // measured 33.06
    EXPECT_GE(normal_db, 32.8);  // measured 33.14
    EXPECT_GE(exact_db, 33.1);   // measured 33.20
}

}  // namespace
}  // namespace aftershade::test::dof
