// What bokeh_hexagon must do, against closed forms and against a renderer's own lens.
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/compare/metrics.h"
#include "framework/image/capture.h"
#include "tests/lens.h"
#include "tests/look_runner.h"
#include "tests/polygon.h"
#include "tests/real_captures.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kFocusM = float(Lens::kFocusM);
constexpr float kIntensity = 1000;

Image blur(const Capture& capture, double radius_px, const std::string& more = "",
           gpu::Backend backend = gpu::Backend::osmesa) {
    const Lens lens{radius_px, capture.header.display_window.width()};
    return LookRunner(lens.look("bokeh_hexagon", more), backend).color(capture);
}

Capture point_of_light(int size, bool is_near) {
    return make_capture({.width = size,
                         .height = size,
                         .background_depth_m = is_near ? kFocusM / 2 : kInfinity,
                         .points = {{size / 2, size / 2, kIntensity}}});
}

double sum_of(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += image.at(x, y, 0);
    return sum;
}

// ---- the shape of a light ----

struct ShapeCase {
    double radius_px;
    double rotation_deg;
    bool is_near;
};

void PrintTo(const ShapeCase& c, std::ostream* out) {
    *out << "R " << c.radius_px << " rotation " << c.rotation_deg << (c.is_near ? " near" : " far");
}

class BokehHexagonShape : public testing::TestWithParam<ShapeCase> {};

TEST_P(BokehHexagonShape, OfAPixelOfLightIsAnEvenHexagonWithAllItsEnergy) {
    const ShapeCase& c = GetParam();
    const int size = c.radius_px > 40 ? 256 : c.radius_px > 20 ? 128 : 64, center = size / 2;
    const Image image =
        blur(point_of_light(size, c.is_near), c.radius_px, fmt::format(R"("rotation": {})", c.rotation_deg));
    EXPECT_NEAR(sum_of(image), kIntensity, 0.01 * kIntensity);
    const auto hexagon = [&](double radius_px) {
        return coverage(regular_polygon(6, radius_px, c.rotation_deg), size, size, center, center);
    };
    const double iou = shape_iou(image, image.at(center, center, 0), hexagon(c.radius_px));
    RecordProperty("iou", fmt::format("{:.4f}", iou));
    EXPECT_GE(iou, c.radius_px < 8 ? 0.9 : 0.97);

    // Off the soft edge, which is wider on the coarse grid.
    const Image inside = hexagon(c.radius_px - (c.radius_px < 12 ? 2.5 : 4.5));
    double sum = 0, squares = 0;
    int count = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            if (inside.at(x, y, 0) < 1) continue;
            sum += image.at(x, y, 0);
            squares += double(image.at(x, y, 0)) * image.at(x, y, 0);
            ++count;
        }
    ASSERT_GT(count, 0);
    const double mean = sum / count, deviation = std::sqrt(std::max(squares / count - mean * mean, 0.0));
    RecordProperty("deviation", fmt::format("{:.4f}", deviation / mean));
    EXPECT_LT(deviation, 0.03 * mean);
}

std::vector<ShapeCase> shapes() {
    std::vector<ShapeCase> cases;
    for (const double radius_px : {4.0, 8.0, 11.7, 12.3, 16.0, 24.5})
        for (const double rotation_deg : {0.0, 7.0, 15.0, 30.0, 101.0})
            cases.push_back({radius_px, rotation_deg, int(radius_px + rotation_deg) % 2 == 0});
    cases.push_back({16, 0, false});
    cases.push_back({48, 10, true});
    return cases;
}
INSTANTIATE_TEST_SUITE_P(All, BokehHexagonShape, testing::ValuesIn(shapes()));

// ---- what must not change ----

Capture varied_depth(SyntheticScene scene) {
    Capture capture = make_capture(scene);
    std::uint32_t state = 1;
    for (float& depth_m : capture.images["depth"].floats()) {
        state = state * 1664525u + 1013904223u;
        depth_m = 0.5f + float(state >> 16) / 65536.0f * 10;
    }
    return capture;
}

class BokehHexagonSettings : public testing::TestWithParam<const char*> {};

TEST_P(BokehHexagonSettings, LeaveAUniformImageUnchanged) {
    const Capture capture =
        varied_depth({.width = 96, .height = 62, .background = {0.7f, 0.4f, 12.0f}, .alpha = 0.5f});
    const Image blurred = blur(capture, 12, GetParam());
    for (int y = 0; y < 62; ++y)
        for (int x = 0; x < 96; ++x)
            for (int c = 0; c < 4; ++c) {
                const float source = capture.images.at("color").at(x, y, c);
                ASSERT_NEAR(blurred.at(x, y, c), source, 2e-6 * source + (c == 3 ? 5e-4 : 0))
                    << x << " " << y << " " << c;
            }
}

INSTANTIATE_TEST_SUITE_P(All, BokehHexagonSettings, testing::Values(R"("rotation": 0)", R"("rotation": 17)"));

TEST(BokehHexagon, CopiesPixelsInFocusBitForBit) {
    Capture capture = make_capture({.width = 64, .height = 36, .background_depth_m = kFocusM});
    for (std::size_t i = 0; i < capture.images["color"].floats().size(); ++i)
        capture.images["color"].floats()[i] = float(i) * 0.37f;
    const Image out = blur(capture, 20);
    const auto expected = capture.images["color"].floats();
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), out.floats().begin()));
}

TEST(BokehHexagon, KeepsAFocusedObjectOutOfTheBlurBehindIt) {
    const SyntheticBox box{
        .x = 20, .y = 10, .width = 24, .height = 20, .depth_m = kFocusM, .color = {9, 9, 9}};
    for (const double radius_px : {6, 12}) {
        const Image out = blur(make_capture({.width = 96, .height = 48, .box = box}, 0), radius_px);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 96; ++x) {
                const bool in_box = x >= 20 && x < 44 && y >= 10 && y < 30;
                ASSERT_NEAR(out.at(x, y, 0), in_box ? 9 : 0, 0.01f) << x << " " << y << " R " << radius_px;
            }
    }
}

/// A half plane at half the focus distance, with its edge at x = 63.5, before what is in focus.
TEST(BokehHexagon, LetsHalfOfTheLightPastTheEdgeOfANearObject) {
    const SyntheticBox box{
        .x = 0, .y = -10, .width = 64, .height = 84, .depth_m = kFocusM / 2, .color = {1, 0, 0}};
    const Capture capture = make_capture(
        {.width = 96, .height = 64, .background = {0, 0.5f, 0}, .background_depth_m = kFocusM, .box = box},
        0);
    for (const double radius_px : {9, 14}) {
        const Image out = blur(capture, radius_px);
        for (int x = 64; x < 80; ++x) {
            // The share of a hexagon beyond x, where its sides are 0.866 R away.
            const double at = std::min((x - 63.5) / radius_px, std::sqrt(0.75));
            const double share = 0.5 - (2 * at - at * at / std::sqrt(3.0)) / (1.5 * std::sqrt(3.0));
            EXPECT_NEAR(out.at(x, 32, 0), share, x == 64 ? 0.08 : 0.03) << x;
            EXPECT_NEAR(out.at(x, 32, 1), 0.5 * (1 - out.at(x, 32, 0)), 0.02) << x;
        }
    }
}

TEST(BokehHexagon, BlursAlphaWithTheColorThatItCovers) {
    const SyntheticBox box{
        .x = 20, .y = 10, .width = 24, .height = 20, .depth_m = kInfinity, .color = {1, 1, 1}};
    const Image out = blur(make_capture({.width = 96, .height = 48, .alpha = 0, .box = box}, 0), 6);
    for (int x = 10; x < 56; ++x) ASSERT_NEAR(out.at(x, 20, 3), out.at(x, 20, 0), 2e-3f) << x;
    EXPECT_GT(out.at(18, 20, 3), 0.05f);
    EXPECT_LT(out.at(18, 20, 3), 0.95f);
}

TEST(BokehHexagon, GivesTheSameBitsOnBothSoftwareBackends) {
    Capture capture = varied_depth({.width = 96, .height = 64, .background = {0.2f, 0.1f, 0.05f}});
    for (int i = 0; i < 96 * 64; i += 37) capture.images["color"].floats()[std::size_t(i) * 4] = float(i);
    const std::string more = R"("rotation": 7)";
    const Image egl = blur(capture, 12, more, gpu::Backend::egl_software);
    const Image osmesa = blur(capture, 12, more);
    EXPECT_TRUE(std::equal(egl.floats().begin(), egl.floats().end(), osmesa.floats().begin()));
}

// ---- against a renderer's lens ----

/// captures/suzanne/README.md: the sharp input has 21.7 dB, a layered reference in double precision 30.2.
TEST(BokehHexagonOnSuzanne, ComesWithinReachOfTheRenderersLens) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "suzanne");
    Sequence sequence;
    sequence.files = FramePattern((*folder / "large/gbuffer_####.exr").string());
    sequence.profile = "blender";
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    const std::vector<std::string> roles{"color", "depth"};
    const Capture capture = reader.read(4, roles);
    const ExrFile truth_file(*folder / "truth/dof_0004.exr");
    const Image truth = truth_file.read_floats(0, std::vector<std::string>{"R", "G", "B"});
    LookRunner runner(
        R"({"aftershade": 1, "steps": [{"effect": "bokeh_hexagon", "params": {"focus_distance": 6.4,
        "focal_length": 50, "f_number": 0.25, "sensor_width": 36, "lens_model": "pinhole"}}]})",
        gpu::Backend::osmesa);
    const double db = display_psnr_db(truth, runner.color(capture));
    fmt::print("PSNR against the lens: {:.2f} dB\n", db);
    EXPECT_GE(db, 31.0);  // measured 31.3; the project asks for 27
}

}  // namespace
}  // namespace aftershade::test
