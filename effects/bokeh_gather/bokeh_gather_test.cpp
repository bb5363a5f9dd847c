// What bokeh_gather must do, against closed forms and against a renderer's own lens.
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/aperture_checks.h"

namespace aftershade::test {
namespace {

constexpr float kIntensity = kPointIntensity;

Image blur(const Capture& capture, double radius_px, const std::string& more = "",
           gpu::Backend backend = gpu::Backend::osmesa) {
    return through_aperture("bokeh_gather", capture, radius_px, more, backend);
}

// ---- the shape of a light ----

struct ShapeCase {
    int blades;
    double radius_px;
    double rotation_deg;
    bool is_near;
    double least_iou;
};

void PrintTo(const ShapeCase& c, std::ostream* out) {
    *out << c.blades << " blades R " << c.radius_px << " rotation " << c.rotation_deg
         << (c.is_near ? " near" : " far");
}

class BokehGatherShape : public testing::TestWithParam<ShapeCase> {};

TEST_P(BokehGatherShape, OfAPixelOfLightIsTheApertureWithAllItsEnergy) {
    const ShapeCase& c = GetParam();
    const int size = 64, center = size / 2;
    const std::string shape = fmt::format(
        R"("blades": {}, "rotation": {}, "taps": 1024, "sampler": "nearest")", c.blades, c.rotation_deg);
    const Image image = blur(point_of_light(size, c.is_near), c.radius_px, shape);
    EXPECT_NEAR(sum_of(image), kIntensity, 0.01 * kIntensity);
    const int sides = c.blades == 0 ? 256 : c.blades;
    const std::vector<Vertex> outline =
        regular_polygon(sides, c.radius_px, c.rotation_deg + (c.is_near ? 180 : 0));
    const double iou =
        shape_iou(image, image.at(center, center, 0), coverage(outline, size, size, center, center));
    RecordProperty("iou", fmt::format("{:.4f}", iou));
    EXPECT_GE(iou, c.least_iou);
}

std::vector<ShapeCase> shapes() {
    std::vector<ShapeCase> cases;
    for (const int blades : {0, 3, 5, 6, 7})
        for (const double radius_px : {4.0, 8.0, 16.0})
            for (const bool is_near : {false, true})
                cases.push_back(
                    {blades, radius_px, is_near ? 13.0 : 0.0, is_near, radius_px < 8 ? 0.9 : 0.97});
    cases.push_back({6, 15.3, 30, false, 0.97});
    cases.push_back({12, 16, 5, true, 0.97});
    return cases;
}
INSTANTIATE_TEST_SUITE_P(All, BokehGatherShape, testing::ValuesIn(shapes()));

double iou_at_16_px(const std::string& sampler, int taps) {
    const int size = 64, center = size / 2;
    const Image image =
        blur(point_of_light(size, false), 16, fmt::format(R"("sampler": "{}", "taps": {})", sampler, taps));
    return shape_iou(image, image.at(center, center, 0),
                     coverage(regular_polygon(6, 16, 0), size, size, center, center));
}

TEST(BokehGather, NeedsATapForEachPixelOfTheApertureToLeaveNoGaps) {
    EXPECT_GE(iou_at_16_px("nearest", 665), 0.97);  // 2.598 * 16^2
    EXPECT_GE(iou_at_16_px("nearest", 640), 0.97);
    EXPECT_LT(iou_at_16_px("nearest", 600), 0.97);
}

TEST(BokehGather, FillsGapsBetweenFewTapsByMips) {
    EXPECT_LT(iou_at_16_px("nearest", 170), 0.3);
    EXPECT_GE(iou_at_16_px("mips", 170), 0.8);  // of blocks of 2 x 2 px
}

TEST(BokehGather, BendsItsBladesIntoADisk) {
    const int size = 64, center = size / 2;
    double before = 0;
    const Image disk = coverage(regular_polygon(256, 16, 0), size, size, center, center);
    for (const double curvature : {0.0, 0.3, 0.6, 1.0}) {
        const Image image = blur(point_of_light(size, false), 16,
                                 fmt::format(R"("blades": 5, "taps": 1024, "curvature": {})", curvature));
        const double iou = shape_iou(image, image.at(center, center, 0), disk);
        EXPECT_GT(iou, before);
        before = iou;
    }
    EXPECT_GE(before, 0.97);
}

TEST(BokehGather, TakesTheShapeOfAPictureOfTheAperture) {
    const int size = 96, center = size / 2;
    for (const bool is_near : {false, true}) {
        Capture capture = point_of_light(size, is_near);
        // Closed above the middle; below it a quarter passes on the right.
        Image picture(size, size, 4);
        for (int y = size / 2; y < size; ++y)
            for (int x = 0; x < size; ++x) picture.at(x, y, 0) = x < size / 2 ? 1.0f : 0.25f;
        capture.images["aov:aperture"] = picture;
        const Image image = blur(capture, 12, R"("blades": 0, "taps": 1024)");
        EXPECT_NEAR(sum_of(image), kIntensity, 0.01 * kIntensity);
        const int side = is_near ? -1 : 1;
        const double full = kIntensity / (std::numbers::pi * 12 * 12 / 4 * 1.25);
        EXPECT_NEAR(image.at(center - side * 5, center + side * 5, 0), full, 0.05 * full);
        EXPECT_NEAR(image.at(center + side * 5, center + side * 5, 0), full / 4, 0.05 * full);
        EXPECT_EQ(image.at(center + 5, center - side * 5, 0), 0);
        EXPECT_EQ(image.at(center - side * 11, center + side * 11, 0), 0);
    }
}

// ---- what must not change ----

class BokehGatherSettings : public testing::TestWithParam<const char*> {};

TEST_P(BokehGatherSettings, LeaveAUniformImageUnchanged) {
    const Capture capture =
        aperture_random_depths({.width = 96, .height = 62, .background = {0.7f, 0.4f, 12.0f}, .alpha = 0.5f});
    const Image blurred = blur(capture, 12, GetParam());
    for (int y = 0; y < 62; ++y)
        for (int x = 0; x < 96; ++x)
            for (int c = 0; c < 4; ++c) {
                const float source = capture.images.at("color").at(x, y, c);
                ASSERT_NEAR(blurred.at(x, y, c), source, 2e-6 * source) << x << " " << y << " " << c;
            }
}

INSTANTIATE_TEST_SUITE_P(All, BokehGatherSettings,
                         testing::Values(R"("blades": 3)", R"("blades": 0, "taps": 32, "sampler": "mips")",
                                         R"("blades": 7, "rotation": 17, "curvature": 0.5)",
                                         R"("taps": 32)"));

TEST(BokehGather, CopiesPixelsInFocusBitForBit) {
    Capture capture = make_capture({.width = 64, .height = 36, .background_depth_m = kApertureFocusM});
    for (std::size_t i = 0; i < capture.images["color"].floats().size(); ++i)
        capture.images["color"].floats()[i] = float(i) * 0.37f;
    const Image out = blur(capture, 20);
    const auto expected = capture.images["color"].floats();
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), out.floats().begin()));
}

TEST(BokehGather, KeepsAFocusedObjectOutOfTheBlurBehindIt) {
    const SyntheticBox box{
        .x = 20, .y = 10, .width = 24, .height = 20, .depth_m = kApertureFocusM, .color = {9, 9, 9}};
    for (const char* settings : {R"("taps": 256)", R"("sampler": "mips", "taps": 32)"}) {
        const Image out = blur(make_capture({.width = 96, .height = 48, .box = box}, 0), 12, settings);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 96; ++x) {
                const bool in_box = x >= 20 && x < 44 && y >= 10 && y < 30;
                ASSERT_NEAR(out.at(x, y, 0), in_box ? 9 : 0, 1e-5f) << x << " " << y << settings;
            }
    }
}

/// A half plane at half the focus distance, with its edge at x = 63.5, before what is in focus.
TEST(BokehGather, LetsHalfOfTheLightPastTheEdgeOfANearObject) {
    const SyntheticBox box{
        .x = 0, .y = -10, .width = 64, .height = 84, .depth_m = kApertureFocusM / 2, .color = {1, 0, 0}};
    const Capture capture = make_capture({.width = 96,
                                          .height = 64,
                                          .background = {0, 0.5f, 0},
                                          .background_depth_m = kApertureFocusM,
                                          .box = box},
                                         0);
    // The half plane's share of a square's area, 14.142 px across, beyond x.
    const Image out = blur(capture, 10, R"("blades": 4, "taps": 1024)");
    for (int x = 64; x < 78; ++x) {
        const double share = std::clamp(0.5 - (x - 63.5) / (std::sqrt(2.0) * 10), 0.0, 1.0);
        EXPECT_NEAR(out.at(x, 32, 0), share, 0.03) << x;
        EXPECT_NEAR(out.at(x, 32, 1), 0.5 * (1 - share), 0.02) << x;
    }
}

TEST(BokehGather, BlursAlphaWithTheColorThatItCovers) {
    expect_alpha_blurs_with_color("bokeh_gather", 2e-3f);
}

TEST(BokehGather, GivesTheSameBitsOnBothSoftwareBackends) {
    Capture capture = aperture_random_depths({.width = 96, .height = 64, .background = {0.2f, 0.1f, 0.05f}});
    for (int i = 0; i < 96 * 64; i += 37) capture.images["color"].floats()[std::size_t(i) * 4] = float(i);
    const std::string more = R"("blades": 5, "curvature": 0.3, "rotation": 7, "sampler": "mips", "taps": 64)";
    const Image egl = blur(capture, 12, more, gpu::Backend::egl_software);
    const Image osmesa = blur(capture, 12, more);
    EXPECT_TRUE(std::equal(egl.floats().begin(), egl.floats().end(), osmesa.floats().begin()));
}

// ---- against a renderer's lens ----

/// The sharp input has 21.7 dB, a layered reference in double precision 30.2.
TEST(BokehGatherOnSuzanne, ComesWithinReachOfTheRenderersLens) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    const double db = suzanne_through_aperture_db("bokeh_gather", *folder);
    EXPECT_GE(db, 31.5);  // measured 32.06
}

}  // namespace
}  // namespace aftershade::test
