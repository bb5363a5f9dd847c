// Preset seed_2013 against listings A.1 and A.2 of Post 2013, Depth of Field and Motion Blur in Realtime
// Computer Graphics, written again in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "effects/bokeh/bokeh_test.h"
#include "tests/backends.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::bokeh {
namespace {

constexpr int kWidth = 64, kHeight = 48;  // the listing's aspect ratio, 640 / 480
constexpr double kMaxCocRadiusPx = 12;

using Rgba = std::array<double, 4>;

template <typename T>
T mix(T a, T b, double t) {
    return a + (b - a) * t;
}
template <>
Rgba mix(Rgba a, Rgba b, double t) {
    for (std::size_t c = 0; c < 4; ++c) a[c] = mix(a[c], b[c], t);
    return a;
}

template <typename T>
struct Texture {
    std::vector<T> texels = std::vector<T>(std::size_t(kWidth * kHeight));

    T& at(int x, int y) { return texels[std::size_t(y * kWidth + x)]; }
    T clamped(int x, int y) const {
        return texels[std::size_t(std::clamp(y, 0, kHeight - 1) * kWidth + std::clamp(x, 0, kWidth - 1))];
    }
    /// texture2D: bilinear, edges clamped.
    T operator()(double u, double v) const {
        const double x = u * kWidth - 0.5, y = v * kHeight - 0.5;
        const int i = int(std::floor(x)), j = int(std::floor(y));
        return mix(mix(clamped(i, j), clamped(i + 1, j), x - i),
                   mix(clamped(i, j + 1), clamped(i + 1, j + 1), x - i), y - j);
    }
};

struct Scene {
    Texture<Rgba> color;
    Texture<double> coc, depth;
};

/// One pass: listing A.1's samples, then A.2.
Texture<Rgba> listing_pass(const Texture<Rgba>& color, const Scene& scene, double angle) {
    constexpr int kSamples = 6;
    constexpr double kRadius = 0.1, kBleedingMult = 0.5, kBleedingBias = 0.01;
    const double aspect = double(kWidth) / kHeight;
    const double point_x = kRadius * std::cos(angle) / aspect, point_y = kRadius * std::sin(angle);
    Texture<Rgba> out;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double u = (x + 0.5) / kWidth, v = (y + 0.5) / kHeight;
            const double coc = scene.coc.clamped(x, y), depth = scene.depth.clamped(x, y);
            Rgba sum{};
            double weights = 0;
            for (int i = 0; i < kSamples; ++i) {
                const double t = double(i) / (kSamples - 1);
                const double s_u = u + mix(-point_x, point_x, t) * coc,
                             s_v = v + mix(-point_y, point_y, t) * coc;
                const double sample_coc = scene.coc(s_u, s_v);
                double weight = scene.depth(s_u, s_v) < depth ? sample_coc * kBleedingMult : 1.0;
                weight = coc > sample_coc + kBleedingBias ? weight : 1.0;
                weight = std::clamp(weight, 0.0, 1.0);
                const Rgba sample = color(s_u, s_v);
                for (std::size_t c = 0; c < 4; ++c) sum[c] += sample[c] * weight;
                weights += weight;
            }
            for (double& value : sum) value /= weights;
            out.at(x, y) = sum;
        }
    return out;
}

/// Two passes along each pair of angles, combined by max.
Texture<Rgba> listings(const Scene& scene) {
    const double quarter = std::numbers::pi / 4;
    const Texture<Rgba> first = listing_pass(scene.color, scene, 0);
    const Texture<Rgba> a = listing_pass(first, scene, -quarter), b = listing_pass(first, scene, quarter);
    Texture<Rgba> out;
    for (std::size_t i = 0; i < out.texels.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) out.texels[i][c] = std::max(a.texels[i][c], b.texels[i][c]);
    return out;
}

Capture random_capture(float nearest_m, float range_m) {
    Capture capture = make_capture({.width = kWidth, .height = kHeight});
    std::uint32_t state = 3;
    const auto random = [&state] {
        state = state * 1664525u + 1013904223u;
        return float(state >> 8) / float(1 << 24);
    };
    for (float& value : capture.images["color"].floats()) value = random();
    for (float& depth_m : capture.images["depth"].floats()) depth_m = nearest_m + range_m * random();
    return capture;
}

/// CoC from 0 to 1 by equation 2.1 with a sensor at the focal length.
Scene scene_of(const Capture& capture, double at_infinity_px) {
    Scene scene;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            for (int c = 0; c < 4; ++c)
                scene.color.at(x, y)[std::size_t(c)] = capture.images.at("color").at(x, y, c);
            const double depth_m = capture.images.at("depth").at(x, y, 0);
            const double radius_px = at_infinity_px * std::abs(depth_m - kFocusM) / depth_m;
            scene.coc.at(x, y) = std::min(radius_px, kMaxCocRadiusPx) / kMaxCocRadiusPx;
            scene.depth.at(x, y) = depth_m;
        }
    return scene;
}

std::string seed_look(const std::string& params) {
    return fmt::format(
        R"({{"aftershade": 1, "steps": [{{"effect": "bokeh", "preset": "seed_2013", "params": {{
        "focus_distance": {}, "sensor_width": {}, "max_coc_radius": {}, {}}}}}]}})",
        kFocusM, kSensorWidthMm, kMaxCocRadiusPx, params);
}

struct DepthCase {
    const char* name;
    float nearest_m, range_m;
};

class BokehPresetSeed2013 : public testing::TestWithParam<DepthCase> {};

TEST_P(BokehPresetSeed2013, IsTheListingsToFloatPrecision) {
    const Capture capture = random_capture(GetParam().nearest_m, GetParam().range_m);
    const Image out = LookRunner(seed_look(lens(9, kWidth)), gpu::test_backend()).color(capture);
    const Texture<Rgba> expected = listings(scene_of(capture, 9));
    double most = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 4; ++c)
                most = std::max(most, std::abs(out.at(x, y, c) - expected.clamped(x, y)[std::size_t(c)]));
    RecordProperty("most", fmt::format("{:.3g}", most));
    EXPECT_LE(most, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(All, BokehPresetSeed2013,
                         testing::Values(DepthCase{"both_sides", 0.8f, 8}, DepthCase{"far", 2.1f, 30},
                                         DepthCase{"near_and_cut", 0.4f, 1.2f}),
                         [](const auto& depth) { return std::string(depth.param.name); });

TEST(BokehPresetSeed2013, CopiesWhatIsExactlyInFocusAndKeepsAUniformImage) {
    Capture capture = random_capture(float(kFocusM), 0);
    const Image in_focus = LookRunner(seed_look(lens(9, kWidth)), gpu::test_backend()).color(capture);
    const auto expected = capture.images.at("color").floats();
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), in_focus.floats().begin()));

    capture = random_capture(0.8f, 8);
    capture.images["depth"].at(5, 5, 0) = std::numeric_limits<float>::infinity();
    for (float& value : capture.images["color"].floats()) value = 0.7f;
    const Image uniform = LookRunner(seed_look(lens(9, kWidth)), gpu::test_backend()).color(capture);
    for (const float value : uniform.floats()) ASSERT_NEAR(value, 0.7f, 2e-6f * 0.7f);
}

}  // namespace
}  // namespace aftershade::test::bokeh
