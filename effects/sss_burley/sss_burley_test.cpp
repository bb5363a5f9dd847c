// Samples of the profile: against closed forms, and against the sum that they are samples of.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/real_captures.h"
#include "tests/scattering_checks.h"

namespace aftershade::test::sss_burley {
namespace {

constexpr const char* kEffect = "sss_burley";

std::string samples(int count, const std::string& more = "") {
    return "\"samples\": " + std::to_string(count) + (more.empty() ? "" : ", ") + more;
}

TEST(SssBurley, HasTheEdgeResponseOfEachChannel) {
    const int size = 480;
    const Capture capture = lit_plane(size, size, edge_light(size));
    const Image image =
        scattered(scattering_step(kEffect, burley_of_px(16, 12, 8, size), samples(256)), capture);
    EXPECT_LT(edge_error(image, {16, 12, 8}, 60, 96), 0.01);
}

TEST(SssBurley, HasTheModulationOfACosine) {
    expect_modulation_of_a_cosine(kEffect, {384, {8, 4, 2}, {24, 48, 96}, 192, 64});
}

/// Few samples too, and none of the ways to draw them: what they would find on a plane is known.
TEST(SssBurley, LeavesEvenLightEven) {
    for (const char* sampling : {"channels", "widest", "widest_fit", "widest_fit_unbiased"})
        for (const char* normalize : {"missing", "all"})
            expect_even_light_stays(kEffect,
                                    samples(16, R"("sampling": ")" + std::string(sampling) +
                                                    R"(", "normalize": ")" + normalize + "\""),
                                    1e-3);
}

TEST(SssBurley, KeepsTheEnergyOfLightFarInsideTheSilhouette) {
    expect_energy_kept(kEffect, samples(256), 0.005);
}
TEST(SssBurley, LetsNothingCrossSilhouettes) {
    expect_nothing_crosses_silhouettes(kEffect, "");
}
TEST(SssBurley, LeavesTheBitsOfWhatDoesNotScatter) {
    expect_the_rest_keeps_its_bits(kEffect, "");
}
TEST(SssBurley, TakesEachObjectsProfile) {
    expect_profiles_by_object(kEffect, "");
}
/// A sample on the border of two pixels may fall on the other one by a rounding.
TEST(SssBurley, KnowsTheWorldsUnit) {
    expect_world_unit_scales(kEffect, "", 5e-5);
}
TEST(SssBurley, LeavesLightThatIsNoNumberAlone) {
    expect_no_number_stays_alone(kEffect, "");
}

TEST(SssBurley, ChangesTheHeadOfSuzanneAlone) {
    expect_the_head_of_suzanne_alone_changes(kEffect, "");
}

/// What came in has 22.2 dB; a throw-away sum in double, normalised, 27.5.
TEST(SssBurley, IsAsNearToCyclesAsTheSumOverTheVisibleSurfaceCanBe) {
    AFTERSHADE_REQUIRE_CAPTURE(folder, "head");
    EXPECT_GT(cycles_head_db(*folder, kEffect, samples(64)), 27.7);
    EXPECT_GT(cycles_head_db(*folder, kEffect, samples(64, R"("geometry": "axes")")), 30);
    EXPECT_GT(cycles_head_db(*folder, kEffect, samples(1024)), 27.7);
    EXPECT_GT(cycles_head_db(*folder, kEffect, samples(1024, R"("geometry": "axes")")), 30.5);
}

double rmse(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.floats().size(); ++i)
        if (i % 4 != 3) sum += std::pow(double(a.floats()[i]) - b.floats()[i], 2);
    return std::sqrt(sum / (double(a.floats().size()) * 0.75));
}

/// Bumps, folds and an edge of light: what is hidden, tilted and missing is in it.
Capture rough_surface(int width, int height) {
    Capture capture = lit_plane(width, height, [](int x, int y, int c) {
        return (x / 12 + y / 9) % 2 ? 1.0f : 0.1f + 0.1f * float(c);
    });
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            capture.images.at("depth").at(x, y, 0) = float(1 + 0.03 * std::sin(x * 0.15) * std::cos(y * 0.1));
    return capture;
}

/// The promise of a sampled mean of the same sum: the error falls at least as the root of the number of
/// samples.
TEST(SssBurley, ConvergesToTheSumOverAllFacets) {
    const Capture capture = rough_surface(120, 80);
    const std::string profile = burley_of_px(5, 3, 1.5, 120);
    for (const char* geometry : {"space", "axes"})
        for (const char* normalize : {"none", "missing", "all"}) {
            const std::string same =
                R"("geometry": ")" + std::string(geometry) + R"(", "normalize": ")" + normalize + "\"";
            const Image exact = scattered(scattering_step("sss_exact", profile, same), capture);
            std::vector<double> errors;
            for (const int count : {16, 64, 256, 1024})
                errors.push_back(
                    rmse(scattered(scattering_step(kEffect, profile, samples(count, same)), capture), exact));
            for (std::size_t i = 1; i < errors.size(); ++i)
                EXPECT_LE(errors[i], 0.5 * errors[i - 1] + 2e-4) << same << " step " << i;
            EXPECT_LT(errors.back(), 0.006) << same;
        }
}

TEST(SssBurley, ConvergesWhicheverWayItDrawsUnbiasedSamples) {
    const Capture capture = rough_surface(120, 80);
    const std::string profile = burley_of_px(5, 3, 1.5, 120);
    const Image exact = scattered(scattering_step("sss_exact", profile), capture);
    for (const char* sampling : {"channels", "widest", "widest_fit_unbiased"}) {
        const std::string drawn = R"("sampling": ")" + std::string(sampling) + "\"";
        EXPECT_LT(rmse(scattered(scattering_step(kEffect, profile, samples(1024, drawn)), capture), exact),
                  0.007)
            << sampling;
    }
}

TEST(SssBurley, HasOtherNoiseForAnotherSeedAndTheSameForTheSame) {
    const Capture capture = lit_plane(64, 40, edge_light(64));
    const std::string profile = burley_of_px(5, 3, 2, 64);
    const Image one = scattered(scattering_step(kEffect, profile, samples(8)), capture);
    const Image same = scattered(scattering_step(kEffect, profile, samples(8)), capture);
    const Image other = scattered(scattering_step(kEffect, profile, samples(8, R"("seed": 1)")), capture);
    EXPECT_EQ(largest_change(one, same), 0);
    EXPECT_GT(largest_change(one, other), 0.01);
}

/// Any profile, not Burley's alone: sampled by the Burley profile of the same mean square distance.
TEST(SssBurley, ConvergesForGaussiansToo) {
    const int size = 96;
    const Capture capture = lit_plane(size, size, edge_light(size));
    const std::string unit = R"("world_unit": )" + std::to_string(1000 * 0.43 / (2 * mm_per_px(size)));
    const Image exact = scattered(scattering_step("sss_exact", "\"skin\"", unit), capture);
    EXPECT_LT(rmse(scattered(scattering_step(kEffect, "\"skin\"", samples(1024, unit)), capture), exact),
              0.005);
}

}  // namespace
}  // namespace aftershade::test::sss_burley
