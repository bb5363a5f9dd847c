// What every depth of field with an aperture of blades must do, against closed forms: `effect` is its id.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/capture/capture.h"
#include "framework/compare/metrics.h"
#include "tests/backends.h"
#include "tests/lens.h"
#include "tests/look_runner.h"
#include "tests/polygon.h"
#include "tests/real_captures.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

/// In front of the focus plane at half its distance, and at infinity, a pinhole lens has CoC of one radius.
constexpr float kApertureFocusM = Lens::kFocusM, kApertureNearM = kApertureFocusM / 2;
constexpr float kApertureFarM = std::numeric_limits<float>::infinity();

/// `more`: further members of "params".
inline Image through_aperture(const std::string& effect, const Capture& capture, double radius_px,
                              const std::string& more = "", gpu::Backend backend = gpu::test_backend()) {
    const int width = capture.images.at("color").width();
    return LookRunner(Lens{radius_px, width}.look(effect, more), backend).color(capture);
}

constexpr float kPointIntensity = 1000;

/// One bright pixel in the middle of a black square of one depth.
inline Capture point_of_light(int size, bool is_near) {
    return make_capture({.width = size,
                         .height = size,
                         .background_depth_m = is_near ? kApertureNearM : kApertureFarM,
                         .points = {{size / 2, size / 2, kPointIntensity}}});
}

/// Of the first channel.
inline double sum_of(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += double(image.at(x, y, 0));
    return sum;
}

struct AperturePoint {
    int blades;
    double radius_px;
    double rotation_deg;
    bool near;
    double curvature = 0;
};

inline void PrintTo(const AperturePoint& p, std::ostream* out) {
    *out << p.blades << " blades, R " << p.radius_px << ", rotation " << p.rotation_deg << ", curvature "
         << p.curvature << (p.near ? ", near" : ", far");
}

/// One bright pixel on a black plane of one depth: its picture has all its energy, and from 8 px on the
/// polygon's shape, turned by 180 degrees in front of the focus plane.
inline void expect_point_is_the_aperture(const std::string& effect, const AperturePoint& p) {
    SCOPED_TRACE(testing::PrintToString(p));
    const int center = int(std::ceil(p.radius_px)) + 3, size = 2 * center + 1;
    const Image out = through_aperture(effect, point_of_light(size, p.near), p.radius_px,
                                       fmt::format(R"("blades": {}, "rotation": {}, "curvature": {})",
                                                   p.blades, p.rotation_deg, p.curvature));
    EXPECT_NEAR(sum_of(out) / double(kPointIntensity), 1, 0.001);
    if (p.radius_px < 8 || (p.curvature > 0 && p.curvature < 1)) return;
    // 256 corners stand for a disk.
    const int corners = p.blades < 3 || p.curvature == 1 ? 256 : p.blades;
    const double turned_deg = p.rotation_deg + (p.near ? 180 : 0);
    const Image polygon =
        coverage(regular_polygon(corners, p.radius_px, turned_deg), size, size, center, center);
    const double iou = shape_iou(out, double(out.at(center, center, 0)), polygon);
    testing::Test::RecordProperty("iou", fmt::format("{:.4f}", iou));
    EXPECT_GE(iou, 0.97);
}

inline Capture aperture_random_depths(const SyntheticScene& scene) {
    Capture capture = make_capture(scene);
    std::uint32_t state = 1;
    for (float& depth_m : capture.images["depth"].floats()) {
        state = state * 1664525u + 1013904223u;
        depth_m = 0.5f + float(state >> 16) / 65536.0f * 10;
    }
    return capture;
}

struct UniformImage {
    int width = 96;
    int height = 64;
    double radius_px = 12;
    double tolerance = 2e-6;     ///< of a value: a float's rounding, in sums of many taps
    double alpha_tolerance = 0;  ///< more, where alpha is kept as a half
};

inline void expect_uniform_stays_uniform(const std::string& effect, const std::string& more,
                                         const UniformImage& image = {}) {
    const Capture capture = aperture_random_depths(
        {.width = image.width, .height = image.height, .background = {0.7f, 0.4f, 12.0f}, .alpha = 0.5f});
    const Image out = through_aperture(effect, capture, image.radius_px, more);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 4; ++c) {
                const double source = capture.images.at("color").at(x, y, c);
                const double off = image.tolerance * source + (c == 3 ? image.alpha_tolerance : 0);
                ASSERT_NEAR(out.at(x, y, c), source, off) << x << " " << y << " " << c;
            }
}

inline void expect_same_bits(const Image& a, const Image& b) {
    EXPECT_TRUE(std::equal(a.floats().begin(), a.floats().end(), b.floats().begin(), b.floats().end()));
}

/// All of the picture is in focus; `alpha`: of every pixel, or nothing for values that are no alpha.
inline void expect_picture_in_focus_is_copied(const std::string& effect, std::optional<float> alpha = {}) {
    Capture capture = make_capture({.width = 64, .height = 36, .background_depth_m = kApertureFocusM});
    const auto floats = capture.images["color"].floats();
    for (std::size_t i = 0; i < floats.size(); ++i)
        floats[i] = alpha && i % 4 == 3 ? *alpha : float(i) * 0.37f;
    expect_same_bits(through_aperture(effect, capture, 20), capture.images["color"]);
}

inline void expect_focus_stays_bit_for_bit(const std::string& effect) {
    Capture capture = make_capture({.width = 64, .height = 36, .background_depth_m = kApertureFocusM});
    const auto floats = capture.images["color"].floats();
    for (std::size_t i = 0; i < floats.size(); ++i) floats[i] = i % 4 == 3 ? 1.0f : float(i) * 0.37f;
    // What is far cannot cover it, and what is near begins 13 px away.
    for (int y = 0; y < 36; ++y)
        for (int x = 40; x < 64; ++x)
            capture.images["depth"].at(x, y, 0) = x < 53 ? kApertureFarM : kApertureNearM;
    const Image out = through_aperture(effect, capture, 10);
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 40; ++x)
            for (int c = 0; c < 4; ++c)
                ASSERT_EQ(out.at(x, y, c), capture.images.at("color").at(x, y, c)) << x << " " << y;
}

constexpr int kApertureBoxX = 20, kApertureBoxY = 10, kApertureBoxWidth = 24, kApertureBoxHeight = 20;

/// A box before nothing in a picture of 96 x 48; `alpha`: of what is around it.
inline Capture aperture_box(float depth_m, float brightness, float alpha = 1) {
    const SyntheticBox box{.x = kApertureBoxX,
                           .y = kApertureBoxY,
                           .width = kApertureBoxWidth,
                           .height = kApertureBoxHeight,
                           .depth_m = depth_m,
                           .color = {brightness, brightness, brightness}};
    return make_capture({.width = 96, .height = 48, .alpha = alpha, .box = box}, 0);
}

inline bool is_in_aperture_box(int x, int y) {
    return x >= kApertureBoxX && x < kApertureBoxX + kApertureBoxWidth && y >= kApertureBoxY &&
           y < kApertureBoxY + kApertureBoxHeight;
}

/// At most this much of a bright object in focus in the blur behind it.
inline void expect_focus_leaks_at_most(const std::string& effect, float share) {
    const Image out = through_aperture(effect, aperture_box(kApertureFocusM, 9), 12);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x)
            if (!is_in_aperture_box(x, y)) {
                ASSERT_LE(out.at(x, y, 0), share * 9) << x << " " << y;
            }
}

/// The object in focus too, to `tolerance`.
inline void expect_focus_keeps_to_itself(const std::string& effect, double radius_px, double tolerance,
                                         const std::string& more = "") {
    const Image out = through_aperture(effect, aperture_box(kApertureFocusM, 9), radius_px, more);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x)
            ASSERT_NEAR(out.at(x, y, 0), is_in_aperture_box(x, y) ? 9 : 0, tolerance)
                << x << " " << y << " R " << radius_px << " " << more;
}

/// A red half plane at half the focus distance, with its edge at x = 63.5, before a green one in focus.
inline Capture near_half_plane() {
    const SyntheticBox box{
        .x = 0, .y = -10, .width = 64, .height = 84, .depth_m = kApertureNearM, .color = {1, 0, 0}};
    return make_capture({.width = 96,
                         .height = 64,
                         .background = {0, 0.5f, 0},
                         .background_depth_m = kApertureFocusM,
                         .box = box},
                        0);
}

constexpr float kApertureDark = 0.1f;

/// A bright near box from x = 30 to 63 before a dark plane in focus.
inline Capture near_box_before_focus() {
    const SyntheticBox box{
        .x = 30, .y = -10, .width = 34, .height = 80, .depth_m = kApertureNearM, .color = {1, 1, 1}};
    return make_capture({.width = 96,
                         .height = 48,
                         .background = {kApertureDark, kApertureDark, kApertureDark},
                         .background_depth_m = kApertureFocusM,
                         .box = box},
                        0);
}

/// The same with what the box hides, as a second layer.
inline Capture near_box_with_what_it_hides() {
    Capture capture = near_box_before_focus();
    Image color(96, 48, 4), depth(96, 48, 1);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) {
            depth.at(x, y, 0) = x >= 30 && x < 64 ? kApertureFocusM : kApertureFarM;
            for (int c = 0; c < 4 && x >= 30 && x < 64; ++c) color.at(x, y, c) = c == 3 ? 1 : kApertureDark;
        }
    capture.images[RoleId::of_layer(1, "color")] = std::move(color);
    capture.images[RoleId::of_layer(1, "depth")] = std::move(depth);
    return capture;
}

/// A wall in focus of light 1, before which a wire out of focus of light 10 has two fifths of a column of
/// pixels: in layers, and as the picture that these make.
inline Capture wire_of_two_fifths_of_a_column() {
    constexpr int kColumn = 48;
    Capture capture = make_capture(
        {.width = 96, .height = 48, .background = {1, 1, 1}, .background_depth_m = kApertureFocusM}, 0);
    Image first = capture.images["color"], first_depth = capture.images["depth"], second(96, 48, 4),
          second_depth(96, 48, 1);
    std::fill(second_depth.floats().begin(), second_depth.floats().end(),
              std::numeric_limits<float>::infinity());
    for (int y = 0; y < 48; ++y) {
        first_depth.at(kColumn, y, 0) = kApertureNearM;
        second_depth.at(kColumn, y, 0) = kApertureFocusM;
        for (int c = 0; c < 4; ++c) {
            first.at(kColumn, y, c) = 0.4f * (c < 3 ? 10 : 1);
            second.at(kColumn, y, c) = 1;
            capture.images["color"].at(kColumn, y, c) = c < 3 ? 0.4f * 10 + 0.6f : 1;
        }
    }
    capture.images[RoleId::of_layer(0, "color")] = std::move(first);
    capture.images[RoleId::of_layer(0, "depth")] = std::move(first_depth);
    capture.images[RoleId::of_layer(1, "color")] = std::move(second);
    capture.images[RoleId::of_layer(1, "depth")] = std::move(second_depth);
    return capture;
}

/// The wire's two fifths of a pixel, over the width of a square of circumradius 12 px.
inline void expect_wire_dissolves(const std::string& effect, double tolerance) {
    const Image out = through_aperture(effect, wire_of_two_fifths_of_a_column(), 12, R"("blades": 4)");
    const double cover = 0.4 / (2 * 12 / std::sqrt(2.0));
    for (const int x : {42, 46, 48, 50, 54})
        EXPECT_NEAR(out.at(x, 24, 0), 10 * cover + 1 - cover, tolerance) << x;
    EXPECT_NEAR(out.at(30, 24, 0), 1, 1e-4);
}

inline Image near_box_over_focus(const std::string& effect) {
    return through_aperture(effect, near_box_before_focus(), 12, R"("blades": 4)");
}

/// A square of circumradius 12 px reaches 8.485 px: the box's edge at x = 64 becomes a straight ramp, of
/// which the centres of the pixels from `first` on are looked at.
inline void expect_near_ramp(const Image& out, int first, float tolerance) {
    const double reach_px = 12 / std::sqrt(2.0);
    for (int x = first; x < 80; ++x) {
        const double covered = std::clamp((64 + reach_px - (x + 0.5)) / (2 * reach_px), 0.0, 1.0);
        const double expected = covered + (1 - covered) * double(kApertureDark);
        EXPECT_NEAR(double(out.at(x, 24, 0)), expected, double(tolerance)) << x;
    }
}

/// `tolerance`: 2e-3 where alpha is kept as a half.
inline void expect_alpha_blurs_with_color(const std::string& effect, float tolerance = 1e-6f) {
    const Image out = through_aperture(effect, aperture_box(kApertureFarM, 1, 0), 6);
    for (int x = 10; x < 56; ++x) ASSERT_NEAR(out.at(x, 20, 3), out.at(x, 20, 0), tolerance) << x;
    EXPECT_GT(out.at(18, 20, 3), 0.05f);
    EXPECT_LT(out.at(18, 20, 3), 0.95f);
}

/// Every 37th pixel is a light; `step`: by how much each is brighter than the pixel before it.
inline Capture aperture_random_lights(float step = 1000) {
    Capture capture = aperture_random_depths({.width = 96, .height = 64, .background = {0.2f, 0.1f, 0.05f}});
    for (std::size_t i = 0; i < 96 * 64; i += 37) capture.images["color"].floats()[i * 4] = float(i) * step;
    return capture;
}

inline void expect_same_bits_on_both_backends(const std::string& effect,
                                              const std::string& more = R"("blades": 5, "rotation": 7)",
                                              const Capture& capture = aperture_random_lights()) {
    expect_same_bits(through_aperture(effect, capture, 12, more, gpu::Backend::egl_software),
                     through_aperture(effect, capture, 12, more, gpu::test_backend()));
}

/// No darker than the darkest pixel and no brighter than the brightest, up to rounding; so nothing that is no
/// number.
inline void expect_no_light_is_made(const std::string& effect) {
    const Capture capture = aperture_random_lights();
    const Image out = through_aperture(effect, capture, 12);
    const auto lights = capture.images.at("color").floats();
    const float brightest = *std::max_element(lights.begin(), lights.end());
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            ASSERT_GE(out.at(x, y, 0), 0) << x << " " << y;
            ASSERT_LE(out.at(x, y, 0), brightest * 1.0001f) << x << " " << y;
            ASSERT_NEAR(out.at(x, y, 1), 0.1f, 1e-6f) << x << " " << y;
        }
}

/// Frame 4 of $AFTERSHADE_CAPTURES/suzanne, and the picture of it through the renderer's own lens.
struct SuzanneThroughLens {
    Capture sharp;
    Image truth;
};

inline SuzanneThroughLens read_suzanne_through_lens(const std::filesystem::path& folder) {
    Sequence sequence;
    sequence.files = FramePattern((folder / "large/gbuffer_####.exr").string());
    sequence.profile = "blender";
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    const std::vector<std::string> roles{"color", "depth"}, rgb{"R", "G", "B"};
    return {reader.read(4, roles), ExrFile(folder / "truth/dof_0004.exr").read_floats(0, rgb)};
}

/// That lens, as members of "params".
inline const std::string kSuzanneLens = R"("focus_distance": 6.4, "focal_length": 50, "f_number": 0.25,
    "sensor_width": 36, "lens_model": "pinhole")";

/// PSNR, dB, against the renderer's own lens; `folder` is $AFTERSHADE_CAPTURES/suzanne, `more` further
/// members of "params".
inline double suzanne_through_aperture_db(const std::string& effect, const std::filesystem::path& folder,
                                          const std::string& more = "") {
    const SuzanneThroughLens suzanne = read_suzanne_through_lens(folder);
    LookRunner runner(R"({"aftershade": 1, "steps": [{"effect": ")" + effect + R"(", "params": {)" +
                          kSuzanneLens + (more.empty() ? "" : ", " + more) + "}}]}",
                      gpu::test_backend());
    const double db = display_psnr_db(suzanne.truth, runner.color(suzanne.sharp));
    fmt::print("PSNR of {} against the lens: {:.2f} dB {}\n", effect, db, more);
    return db;
}

}  // namespace aftershade::test
