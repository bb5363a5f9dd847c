// The module `lens`, by an effect that shows its CoC.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/backends.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

constexpr float kFocusM = 2;
constexpr int kWidth = 96;

/// Runs the lens over a capture: its CoC, px.
class Lens : public testing::Test {
protected:
    Lens() {
        effects_.add(
            "probe",
            R"("modules": ["lens", "near_coc"], "inputs": { "color": { "role": "color" }, "depth": { "role": "depth" } },
                        "outputs": { "color": { "role": "color" } },
                        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["coc"], "writes": ["color"] } ])",
            "void main() { out_color = vec4(texelFetch(coc, ivec2(gl_FragCoord.xy), 0).r); }\n");
    }
    /// A pinhole lens that gives infinity `radius_px` in an image of kWidth, and half the focus distance
    /// minus it.
    Image coc(const Capture& capture, double radius_px, const std::string& more,
              gpu::Backend backend = gpu::test_backend()) const {
        const double focal_mm = 200, sensor_mm = 36;
        const double aperture_mm = 2 * radius_px * sensor_mm / kWidth * (kFocusM * 1000) / focal_mm;
        const std::string params = R"({"lens_model": "pinhole", "focus_distance": 2, "sensor_width": 36,
            "focal_length": 200, "f_number": )" +
                                   std::to_string(focal_mm / aperture_mm) + more + "}";
        return Bench(effects_, look_of(R"({"effect": "probe", "params": )" + params + "}"), {}, backend)
            .color(capture);
    }
    EffectFolder effects_;
};

const std::string kFilter = R"(, "coc_filter": "near")";

/// A near surface from the left edge to `edge_x`, before what is in focus, both of one colour: nothing to
/// repair.
Capture near_half(int edge_x) {
    const Rgb grey{0.5f, 0.5f, 0.5f};
    const SyntheticBox box{
        .x = -10, .y = -10, .width = edge_x + 10, .height = 99, .depth_m = kFocusM / 2, .color = grey};
    return make_capture(
        {.width = kWidth, .height = 24, .background = grey, .background_depth_m = kFocusM, .box = box});
}

/// Hammon's filter along a row that all rows equal, in double: means of 4, five binomial taps, a linear ramp
/// between the means' centres.
std::vector<double> filtered_row(const std::vector<double>& coc) {
    const int count = int(coc.size()), down = 4, texels = (count + down - 1) / down;
    std::vector<double> mean(std::size_t(texels), 0.0), blurred = mean, result = coc;
    for (int i = 0; i < texels; ++i) {
        const int end = std::min(down * (i + 1), count);
        for (int x = down * i; x < end; ++x)
            mean[std::size_t(i)] += std::max(-coc[std::size_t(x)], 0.0) / (end - down * i);
    }
    const auto at = [&](const std::vector<double>& row, int i) {
        return row[std::size_t(std::clamp(i, 0, texels - 1))];
    };
    for (int i = 0; i < texels; ++i)
        blurred[std::size_t(i)] = (at(mean, i - 2) + 4 * at(mean, i - 1) + 6 * at(mean, i) +
                                   4 * at(mean, i + 1) + at(mean, i + 2)) /
                                  16;
    for (int x = 0; x < count; ++x) {
        const double own = coc[std::size_t(x)], place = (x + 0.5) / down - 0.5, t = place - std::floor(place);
        const int i = int(std::floor(place));
        const double wide = at(blurred, i) * (1 - t) + at(blurred, i + 1) * t, d0 = std::max(-own, 0.0);
        const double near = 2 * std::max(d0, wide) - d0;
        if (near > std::abs(own) + 1.0 / 64) result[std::size_t(x)] = -near;
    }
    return result;
}

TEST_F(Lens, FilterContinuesNearCocAcrossASilhouette) {
    for (const int edge : {45, 46, 47, 48}) {
        const Capture capture = near_half(edge);
        const Image plain = coc(capture, 12, ""), filtered = coc(capture, 12, kFilter);
        std::vector<double> row;
        for (int x = 0; x < kWidth; ++x) row.push_back(x < edge ? -12 : 0);
        const std::vector<double> expected = filtered_row(row);
        int reach = 0;
        for (int x = 0; x < kWidth; ++x) {
            const float radius = filtered.at(x, 12, 0);
            EXPECT_NEAR(plain.at(x, 12, 0), row[std::size_t(x)], 1e-4) << x;
            // llvmpipe filters with weights of 8 bits.
            EXPECT_NEAR(radius, expected[std::size_t(x)], 0.04) << edge << " " << x;
            if (x < edge) {
                EXPECT_EQ(radius, plain.at(x, 12, 0)) << "inside, " << x;
            }
            if (radius < -0.1f) reach = x + 1 - edge;
            if (x > 0) {
                EXPECT_LT(std::abs(radius - filtered.at(x - 1, 12, 0)), 12 * 0.25) << x;
            }
            for (int y = 0; y < 24; ++y) EXPECT_EQ(filtered.at(x, y, 0), radius) << x << " " << y;
        }
        EXPECT_GE(reach, 8) << "two texels of 4 px";
        EXPECT_LE(reach, 13) << "two and a half, and the edge's own";
    }
}

TEST_F(Lens, FilterLeavesWhatHasNoNearNeighbour) {
    // Behind the focus plane everywhere, by many depths; then beside a near surface.
    Capture capture = make_capture({.width = kWidth, .height = 24});
    for (int i = 0; i < kWidth * 24; ++i)
        capture.images["depth"].floats()[std::size_t(i)] = kFocusM * (1 + float(i % 7));
    EXPECT_TRUE(std::ranges::equal(coc(capture, 12, kFilter).floats(), coc(capture, 12, "").floats()));

    capture = near_half(48);
    for (int y = 0; y < 24; ++y)
        for (int x = 48; x < kWidth; ++x) capture.images["depth"].at(x, y, 0) = 2 * kFocusM;
    const Image plain = coc(capture, 12, ""), filtered = coc(capture, 12, kFilter);
    EXPECT_LT(filtered.at(48, 12, 0), -10) << "the near surface's CoC is greater";
    for (int x = 53; x < kWidth; ++x) EXPECT_EQ(filtered.at(x, 12, 0), plain.at(x, 12, 0)) << x;
}

TEST_F(Lens, FilterLeavesAConstantPicture) {
    // Sides that are no multiples of 4, radii that are no round numbers.
    for (const float depth_m : {0.9f, 1.37f, kFocusM, 3.1f}) {
        const Capture capture = make_capture({.width = 61, .height = 35, .background_depth_m = depth_m});
        const Image plain = coc(capture, 33.3, ""), filtered = coc(capture, 33.3, kFilter);
        EXPECT_TRUE(std::ranges::equal(filtered.floats(), plain.floats())) << depth_m;
    }
}

TEST_F(Lens, FilterStaysWithinTheLargestRadius) {
    Capture capture = make_capture({.width = kWidth, .height = 24, .background_depth_m = kFocusM / 2});
    for (int y = 0; y < 24; ++y) capture.images["depth"].at(50, y, 0) = kFocusM;  // a gap of 1 px
    const Image filtered = coc(capture, 40, kFilter + R"(, "max_coc_radius": 20)");
    for (const float radius : filtered.floats()) EXPECT_EQ(radius, -20);
    EXPECT_NEAR(coc(capture, 40, R"(, "max_coc_radius": 20)").at(50, 12, 0), 0, 1e-4);
}

TEST_F(Lens, FilterGivesTheSameBitsOnBothSoftwareBackends) {
    const Capture capture = near_half(46);
    const Image egl = coc(capture, 12, kFilter, gpu::Backend::egl_software);
    EXPECT_TRUE(std::ranges::equal(egl.floats(), coc(capture, 12, kFilter).floats()));
}

TEST_F(Lens, RepairsTheCocOfAPixelThatHasALightsColorBeforeTheDepthBehindIt) {
    Capture capture = make_capture({.width = kWidth, .height = 24, .background_depth_m = kFocusM});
    for (int c = 0; c < 3; ++c) {
        capture.images["color"].at(40, 12, c) = 1000;
        capture.images["color"].at(41, 12, c) = 500;
    }
    capture.images["depth"].at(40, 12, 0) = kFocusM / 2;
    EXPECT_NEAR(coc(capture, 12, "").at(41, 12, 0), -12, 0.05);
    EXPECT_NEAR(coc(capture, 12, "").at(42, 12, 0), 0, 1e-4);
    const Image plain = coc(capture, 12, R"(, "highlight_repair": false)");
    EXPECT_NEAR(plain.at(40, 12, 0), -12, 1e-4);
    EXPECT_NEAR(plain.at(41, 12, 0), 0, 1e-4);
}

}  // namespace
}  // namespace aftershade::test
