// What every effect that scatters irradiance must do, on captures from formulas: a plane that faces the
// camera, 1 m away, under light whose scattering has a closed form.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/capture/capture.h"
#include "framework/capture/profile.h"
#include "framework/capture/sequence.h"
#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/reference/burley.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

using Light = std::function<float(int x, int y, int channel)>;

/// Millimetres of a plane 1 m away under a pixel, with the lens that a capture without a camera is taken to
/// have: 50 mm on a sensor of 36 mm.
inline double mm_per_px(int width) {
    return 1000.0 * 36 / 50 / width;
}

/// Object 1 fills the picture.
inline Capture lit_plane(int width, int height, const Light& light) {
    Capture capture = make_capture({.width = width, .height = height, .background_depth_m = 1});
    capture.images.erase("mask");
    std::erase(capture.header.roles, "mask");
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            capture.images.at("object_id").uint_at(x, y, 0) = 1;
            for (int c = 0; c < 3; ++c) capture.images.at("irradiance").at(x, y, c) = light(x, y, c);
        }
    return capture;
}

constexpr double kFacingPlanePixel_mm = 2;

/// A plane that faces the camera 1 m away, a pixel of it kFacingPlanePixel_mm wide, lit at each pixel's
/// middle; x and y from the picture's middle, px. Its positions are those of a texture with texels of the
/// same size.
inline Capture facing_plane(int width, int height, const std::function<double(double x, double y)>& light) {
    Capture capture = make_capture({.width = width, .height = height, .background_depth_m = 1});
    capture.header.camera.set("focal_length", 50);
    capture.header.camera.set("sensor_width", 50 * kFacingPlanePixel_mm * width / 1000);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double across = x + 0.5 - width / 2, down = y + 0.5 - height / 2;
            const float value = float(light(across, down));
            detail::set_rgb(capture.images["irradiance"], x, y, {value, value, value});
            capture.images["mask"].at(x, y, 0) = 1;
            detail::set_rgb(
                capture.images["position"], x, y,
                {7, float(across * kFacingPlanePixel_mm / 1000), float(down * kFacingPlanePixel_mm / 1000)});
        }
    return capture;
}

/// A Burley profile whose d are so many pixels of lit_plane(), as a look has it.
inline std::string burley_of_px(double r, double g, double b, int width) {
    const double mm = mm_per_px(width);
    return fmt::format(R"({{ "type": "burley", "d_mm": [{}, {}, {}] }})", r * mm, g * mm, b * mm);
}

/// One step; `more` are further parameters: "\"samples\": 16".
inline std::string scattering_step(const std::string& effect, const std::string& profile,
                                   const std::string& more = "") {
    return R"({ "aftershade": 1, "steps": [ { "effect": ")" + effect +
           R"(", "params": { "scattering_profile": )" + profile + (more.empty() ? "" : ", ") + more +
           " } } ] }";
}

inline Image scattered(const std::string& look, const Capture& capture) {
    return LookRunner(look, gpu::test_backend()).run(capture).images.at("irradiance");
}

/// Mean over `rows` rows around the middle one, so that noise does not count.
inline double row_mean(const Image& image, int x, int channel, int rows) {
    double sum = 0;
    const int first = (image.height() - rows) / 2;
    for (int y = first; y < first + rows; ++y) sum += image.at(x, y, channel);
    return sum / rows;
}

/// Largest distance from the edge response of Burley's profile, across an edge of light in the middle of a
/// square picture, within `reach_px` of the edge. `d_px` of the channels.
inline double edge_error(const Image& image, const std::array<double, 3>& d_px, int reach_px, int rows) {
    double worst = 0;
    for (int c = 0; c < 3; ++c)
        for (int off = -reach_px; off < reach_px; ++off) {
            const double expected = reference::burley_edge_response(off + 0.5, d_px[std::size_t(c)]);
            worst = std::max(worst, std::abs(row_mean(image, image.width() / 2 + off, c, rows) - expected));
        }
    return worst;
}

inline Light edge_light(int width) {
    return [width](int x, int, int) { return x >= width / 2 ? 1.0f : 0.0f; };
}

/// 1/2 + 1/2 cos of `period_px`, a crest in the middle column.
inline Light cosine_light(int width, double period_px) {
    return [=](int x, int, int) {
        return float(0.5 + 0.5 * std::cos(2 * std::numbers::pi * (x + 0.5 - 0.5 * width) / period_px));
    };
}

/// The cosine's amplitude, twice, over `periods` of them in the middle.
inline double cosine_amplitude(const Image& image, int channel, double period_px, int periods, int rows) {
    const int width = image.width(), count = int(std::lround(period_px * periods)),
              first = (width - count) / 2;
    double sum = 0;
    for (int x = first; x < first + count; ++x)
        sum += row_mean(image, x, channel, rows) *
               std::cos(2 * std::numbers::pi * (x + 0.5 - 0.5 * width) / period_px);
    return 4 * sum / count;
}

/// A plane under waves of light of these periods, against the modulation that Burley's profile gives them.
struct CosineCheck {
    int size;
    std::array<double, 3> d_px;
    std::vector<double> periods_px;
    int window_px;  ///< of whole periods, that are looked at
    int rows;
};

inline void expect_modulation_of_a_cosine(const std::string& effect, const CosineCheck& check) {
    const auto [size, d_px, periods_px, window_px, rows] = check;
    const std::string look = scattering_step(effect, burley_of_px(d_px[0], d_px[1], d_px[2], size));
    for (const double period_px : periods_px) {
        const Image image = scattered(look, lit_plane(size, size, cosine_light(size, period_px)));
        for (int c = 0; c < 3; ++c) {
            const double d = d_px[std::size_t(c)], w = 2 * std::numbers::pi / period_px;
            EXPECT_NEAR(cosine_amplitude(image, c, period_px, int(window_px / period_px), rows),
                        reference::burley_modulation(w, d), 0.01)
                << "period " << period_px << " d " << d;
        }
    }
}

inline double largest_change(const Image& a, const Image& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.floats().size(); ++i)
        worst = std::max(worst, std::abs(double(a.floats()[i]) - b.floats()[i]));
    return worst;
}

inline bool same_bits_at(const Image& a, const Image& b, int x, int y) {
    for (int c = 0; c < 3; ++c) {
        const float left = a.at(x, y, c), right = b.at(x, y, c);
        if (std::memcmp(&left, &right, sizeof left) != 0) return false;
    }
    return true;
}

inline double sum_of(const Image& image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += image.at(x, y, channel);
    return sum;
}

/// Object 2 on the right half, object 1 on the left; light of both as given.
inline Capture two_objects(int width, int height, const Light& light) {
    Capture capture = lit_plane(width, height, light);
    for (int y = 0; y < height; ++y)
        for (int x = width / 2; x < width; ++x) capture.images.at("object_id").uint_at(x, y, 0) = 2;
    return capture;
}

/// A slanted wall, object 1, and before it a ball, object 2, each in even light, in a picture of 128 x 96.
inline Capture ball_before_wall(float light_of_ball, float light_of_wall) {
    Capture capture = facing_plane(128, 96, [&](double, double) { return light_of_wall; });
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) {
            const double across = (x - 50) / 30.0, down = (y - 48) / 30.0,
                         square = across * across + down * down;
            capture.images["depth"].at(x, y, 0) = 1.2f + 0.003f * float(x);
            capture.images["object_id"].uint_at(x, y, 0) = 1;
            if (square > 1) continue;
            capture.images["depth"].at(x, y, 0) = float(1 - 0.06 * std::sqrt(1 - square));
            capture.images["object_id"].uint_at(x, y, 0) = 2;
            detail::set_rgb(capture.images["irradiance"], x, y,
                            {light_of_ball, light_of_ball, light_of_ball});
        }
    return capture;
}

inline void expect_even_light_stays(const std::string& effect, const std::string& more, double tolerance) {
    const Capture capture = lit_plane(96, 64, [](int, int, int c) { return 0.25f + 0.25f * float(c); });
    const Image& before = capture.images.at("irradiance");
    for (const double d : {0.05, 0.7, 3.0, 9.0}) {
        const Image after =
            scattered(scattering_step(effect, burley_of_px(d, d / 2, d / 4, 96), more), capture);
        EXPECT_LT(largest_change(before, after), tolerance) << "d " << d << " px";
    }
}

/// A disk of light of radius 12 px, 16 d and more inside of the plane's silhouette.
inline void expect_energy_kept(const std::string& effect, const std::string& more, double tolerance) {
    const int size = 160;
    const Capture capture = lit_plane(
        size, size, [](int x, int y, int) { return std::hypot(x - 79.5, y - 79.5) < 12 ? 1.0f : 0.0f; });
    const Image after = scattered(scattering_step(effect, burley_of_px(4, 3, 2, size), more), capture);
    for (int c = 0; c < 3; ++c) {
        const double before = sum_of(capture.images.at("irradiance"), c);
        EXPECT_NEAR(sum_of(after, c) / before, 1, tolerance) << "channel " << c;
    }
}

/// Light of one object reaches no other, whatever it is.
inline void expect_nothing_crosses_silhouettes(const std::string& effect, const std::string& more) {
    const auto light = [](float right) {
        return [right](int x, int y, int) { return x >= 40 ? right : 0.5f + 0.4f * std::sin(float(x * y)); };
    };
    const std::string look = scattering_step(effect, burley_of_px(6, 4, 2, 80), more);
    const Image dark = scattered(look, two_objects(80, 48, light(0)));
    const Image bright = scattered(look, two_objects(80, 48, light(1000)));
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 40; ++x) ASSERT_TRUE(same_bits_at(dark, bright, x, y)) << x << " " << y;
}

/// Objects that are not listed, what is infinitely far away, and what the mask leaves out keep their bits;
/// and give no light.
inline void expect_the_rest_keeps_its_bits(const std::string& effect, const std::string& more) {
    const auto light = [](int x, int y, int c) { return 0.5f + 0.4f * std::sin(float(x * 7 + y * 3 + c)); };
    Capture capture = two_objects(80, 48, light);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 80; ++x)
            capture.images.at("depth").at(x, y, 0) = std::numeric_limits<float>::infinity();
    capture.images["mask"] = Image(80, 48, 1);
    capture.header.roles.push_back("mask");
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 80; ++x) capture.images["mask"].at(x, y, 0) = y < 40 ? 1.0f : 0.0f;
    const std::string only = (more.empty() ? "" : more + ", ") + std::string(R"("object_ids": [1])");
    const Image& before = capture.images.at("irradiance");
    const Image after = scattered(scattering_step(effect, burley_of_px(6, 4, 2, 80), only), capture);
    int changed = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 80; ++x) {
            const bool scatters = x < 40 && y >= 8 && y < 40;
            if (!scatters) {
                ASSERT_TRUE(same_bits_at(before, after, x, y)) << x << " " << y;
            } else changed += !same_bits_at(before, after, x, y);
        }
    EXPECT_GT(changed, 40 * 32 * 9 / 10);
}

/// The right half has a profile of its own, by a row of the table: each half is what it is where its profile
/// is everyone's.
inline void expect_profiles_by_object(const std::string& effect, const std::string& more) {
    const auto light = [](int x, int y, int) { return (x / 10 + y / 10) % 2 ? 1.0f : 0.2f; };
    const Capture capture = two_objects(80, 48, light);
    const std::string wide = burley_of_px(6, 4, 2, 80), narrow = burley_of_px(1, 2, 3, 80);
    const std::string both =
        R"({ "default": )" + wide + R"(, "rows": [ { "object": 2, "profile": )" + narrow + " } ] }";
    const Image got = scattered(scattering_step(effect, both, more), capture);
    const Image left = scattered(scattering_step(effect, wide, more), capture);
    const Image right = scattered(scattering_step(effect, narrow, more), capture);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 80; ++x)
            ASSERT_TRUE(same_bits_at(got, x < 40 ? left : right, x, y)) << x << " " << y;
}

/// The world's unit and the profile's scale are one: a tenth of the one is ten times the other.
inline void expect_world_unit_scales(const std::string& effect, const std::string& more,
                                     double tolerance = 2e-5) {
    const Capture capture = lit_plane(80, 48, edge_light(80));
    const Image one = scattered(scattering_step(effect, burley_of_px(6, 4, 2, 80), more), capture);
    const Image other =
        scattered(scattering_step(effect, burley_of_px(0.6, 0.4, 0.2, 80),
                                  (more.empty() ? "" : more + ", ") + std::string(R"("world_unit": 100)")),
                  capture);
    EXPECT_LT(largest_change(one, other), tolerance);
}

/// A NaN or an infinity of light stays where it is.
inline void expect_no_number_stays_alone(const std::string& effect, const std::string& more) {
    Capture capture = lit_plane(48, 32, [](int, int, int) { return 0.5f; });
    capture.images.at("irradiance").at(20, 10, 1) = std::numeric_limits<float>::quiet_NaN();
    capture.images.at("irradiance").at(30, 20, 0) = std::numeric_limits<float>::infinity();
    const Image after = scattered(scattering_step(effect, burley_of_px(3, 2, 1, 48), more), capture);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x)
            if (!(x == 20 && y == 10) && !(x == 30 && y == 20)) {
                ASSERT_NEAR(after.at(x, y, 1), 0.5, 2e-3) << x << " " << y;
            }
}

inline Capture read_blender_capture(const std::filesystem::path& pattern, int frame,
                                    const std::vector<std::string>& roles) {
    Sequence sequence;
    sequence.files = FramePattern(pattern.string());
    sequence.profile = "blender";
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    return reader.read(frame, roles);
}

/// The head (object 1) scatters; the ball, the cube and the poles do not change by a bit.
inline void expect_the_head_of_suzanne_alone_changes(const std::string& effect, const std::string& more) {
    const std::vector<std::string> roles{"color", "depth", "irradiance", "albedo", "object_id", "normal"};
    const Capture capture =
        read_blender_capture(AFTERSHADE_SOURCE_DIR "/scenes/suzanne/gbuffer_####.exr", 4, roles);
    const std::string look =
        R"({ "aftershade": 1, "steps": [ { "effect": ")" + effect +
        R"(", "params": { "object_ids": [1], "scattering_profile": { "type": "burley", "d_mm": [60, 25, 15] } )" +
        (more.empty() ? "" : ", ") + more + R"( } }, { "effect": "sss_combine" } ] })";
    const Image before = capture.images.at("color"),
                after = LookRunner(look, gpu::test_backend()).color(capture);
    const Image& ids = capture.images.at("object_id");
    int head = 0, changed = 0;
    for (int y = 0; y < before.height(); ++y)
        for (int x = 0; x < before.width(); ++x) {
            const bool is_head = ids.uint_at(x, y, 0) == 1;
            if (!is_head) {
                ASSERT_TRUE(same_bits_at(before, after, x, y)) << x << " " << y;
            }
            head += is_head;
            changed += is_head && !same_bits_at(before, after, x, y);
        }
    EXPECT_GT(head, 10000);
    EXPECT_GT(changed, head * 9 / 10);
}

/// captures/head: PSNR, as its README measures it, against Cycles' own Burley scattering with 4096 samples.
inline double cycles_head_db(const std::filesystem::path& folder, const std::string& effect,
                             const std::string& more) {
    const std::vector<std::string> roles{"irradiance", "depth", "object_id", "normal"};
    const Capture capture = read_blender_capture(folder / "gbuffer_####.exr", 1, roles);
    const std::string profile = R"({ "type": "burley", "albedo": [0.8, 0.5, 0.4], "mapping": "diffuse",
        "mean_free_path_mm": [79.577, 31.831, 19.894] })";
    const Image got = scattered(
        scattering_step(effect, profile, R"("object_ids": [1])" + (more.empty() ? "" : ", " + more)),
        capture);
    const auto channels = [](const char* kind) {
        std::vector<std::string> names;
        for (const char* c : {"R", "G", "B"}) names.push_back("ViewLayer." + std::string(kind) + "." + c);
        return names;
    };
    const ExrFile truth_file(folder / "truth_sss_0001.exr"), file(folder / "gbuffer_0001.exr");
    const Image direct = truth_file.read_floats(0, channels("DiffDir")),
                indirect = truth_file.read_floats(0, channels("DiffInd"));
    // The truth has its albedo twice.
    const Image twice = truth_file.read_floats(0, channels("DiffCol")),
                once = file.read_floats(0, channels("DiffCol"));
    const Image& before = capture.images.at("irradiance");
    std::vector<float> lit;
    for (int y = 0; y < got.height(); ++y)
        for (int x = 0; x < got.width(); ++x)
            for (int c = 0; c < 3; ++c)
                if (capture.images.at("object_id").uint_at(x, y, 0) == 1) lit.push_back(before.at(x, y, c));
    // Light is scaled so that the 90th percentile is a half.
    std::nth_element(lit.begin(), lit.begin() + std::ptrdiff_t(lit.size() * 9 / 10), lit.end());
    const double scale = 0.5 / lit[lit.size() * 9 / 10];
    double sum = 0;
    for (int y = 0; y < got.height(); ++y)
        for (int x = 0; x < got.width(); ++x) {
            if (capture.images.at("object_id").uint_at(x, y, 0) != 1) continue;
            double error = 0;
            for (int c = 0; c < 3; ++c) {
                const double truth =
                    (direct.at(x, y, c) + indirect.at(x, y, c)) * twice.at(x, y, c) / once.at(x, y, c);
                const double luminance[] = {0.2126, 0.7152, 0.0722};
                error += luminance[c] * (std::clamp(truth * scale, 0.0, 1.0) -
                                         std::clamp(double(got.at(x, y, c)) * scale, 0.0, 1.0));
            }
            sum += error * error;
        }
    const double db = -10 * std::log10(sum * 3 / double(lit.size()));
    fmt::print("PSNR of {} against Cycles' head: {:.2f} dB {}\n", effect, db, more);
    return db;
}

}  // namespace aftershade::test
