// What all effects that blur irradiance have in common, as one suite. An effect's test names itself in a type
// and instantiates the suite with it:
//
//     struct Mine {
//         static constexpr const char* kEffect = "mine";
//         static constexpr const char* kWide = "\"wax\"";  // scattering profiles, as looks have them
//         static constexpr const char* kNarrow = "\"skin\"";
//     };
//     INSTANTIATE_TYPED_TEST_SUITE_P(Mine, ScatteringBlur, Mine);
#pragma once

#include <gtest/gtest.h>

#include "tests/scattering_checks.h"

namespace aftershade::test {

/// Light beside a sharp edge, under a mask of a quarter: what scatters is mixed with what came in.
inline void expect_the_mask_mixes(const std::string& effect, const std::string& profile) {
    Capture capture = facing_plane(64, 16, [](double x, double) { return x > 0 ? 2.0 : 0.0; });
    const std::string look = scattering_step(effect, profile);
    const Image whole = scattered(look, capture);
    // Light goes on to come from all that the mask has at all.
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 64; ++x) capture.images.at("mask").at(x, y, 0) = 0.25f;
    const Image quarter = scattered(look, capture);
    for (int x = 0; x < 64; ++x) {
        const double before = capture.images.at("irradiance").at(x, 8, 0);
        EXPECT_NEAR(quarter.at(x, 8, 0), 0.75 * before + 0.25 * whole.at(x, 8, 0), 1e-6) << x;
    }
    EXPECT_GT(std::abs(quarter.at(33, 8, 0) - 2), 0.05);
}

/// Waves in green, so that scattering shows everywhere.
inline void put_waves(Capture& capture) {
    Image& light = capture.images.at("irradiance");
    for (int y = 0; y < light.height(); ++y)
        for (int x = 0; x < light.width(); ++x) light.at(x, y, 1) = std::sin(0.9f * float(x)) + 1.5f;
}

/// Of `after`, where object 2 alone was to scatter.
inline void expect_object_2_alone_changed(const Capture& capture, const Image& after) {
    const Image& before = capture.images.at("irradiance");
    int scattered = 0;
    for (int y = 0; y < before.height(); ++y)
        for (int x = 0; x < before.width(); ++x) {
            const bool ball = capture.images.at("object_id").uint_at(x, y, 0) == 2;
            for (int c = 0; c < 3; ++c) {
                const float was = before.at(x, y, c), is = after.at(x, y, c);
                if (ball) scattered += was != is;
                else ASSERT_EQ(std::memcmp(&was, &is, sizeof was), 0) << x << " " << y;
            }
        }
    EXPECT_GT(scattered, 2000);
}

/// Of green: object 2 as where all have the narrow profile, the rest as where all have the wide one.
inline void expect_object_2_alone_is_narrow(const Capture& capture, const Image& both, const Image& all_wide,
                                            const Image& all_narrow) {
    for (int y = 0; y < both.height(); ++y)
        for (int x = 0; x < both.width(); ++x) {
            const bool ball = capture.images.at("object_id").uint_at(x, y, 0) == 2;
            ASSERT_EQ(both.at(x, y, 1), (ball ? all_narrow : all_wide).at(x, y, 1)) << x << " " << y;
        }
    EXPECT_NE(all_narrow.at(50, 48, 1), all_wide.at(50, 48, 1));
}

template <typename Named>
class ScatteringBlur : public testing::Test {
protected:
    const std::string effect_ = Named::kEffect, wide_ = Named::kWide, narrow_ = Named::kNarrow;
};
TYPED_TEST_SUITE_P(ScatteringBlur);

TYPED_TEST_P(ScatteringBlur, LetsNothingCrossSilhouettes) {
    expect_nothing_crosses_silhouettes(this->effect_, "");
}
TYPED_TEST_P(ScatteringBlur, LeavesTheBitsOfWhatDoesNotScatter) {
    expect_the_rest_keeps_its_bits(this->effect_, "");
}
TYPED_TEST_P(ScatteringBlur, TakesEachObjectsProfile) {
    expect_profiles_by_object(this->effect_, "");
}
TYPED_TEST_P(ScatteringBlur, KnowsTheWorldsUnit) {
    expect_world_unit_scales(this->effect_, "");
}
TYPED_TEST_P(ScatteringBlur, LeavesLightThatIsNoNumberAlone) {
    expect_no_number_stays_alone(this->effect_, "");
}
TYPED_TEST_P(ScatteringBlur, LeavesEvenLightEven) {
    expect_even_light_stays(this->effect_, "", 1e-3);
}
TYPED_TEST_P(ScatteringBlur, KeepsTheEnergyOfLightFarInsideTheSilhouette) {
    expect_energy_kept(this->effect_, "", 0.005);
}
TYPED_TEST_P(ScatteringBlur, ChangesTheHeadOfSuzanneAlone) {
    expect_the_head_of_suzanne_alone_changes(this->effect_, "");
}
TYPED_TEST_P(ScatteringBlur, LeavesObjectsThatDoNotScatterBitForBit) {
    Capture capture = ball_before_wall(0.7f, 3.3f);
    put_waves(capture);
    const std::string look = scattering_step(this->effect_, this->wide_, R"("object_ids": [2])");
    expect_object_2_alone_changed(capture, scattered(look, capture));
}
TYPED_TEST_P(ScatteringBlur, ScattersEachObjectByItsOwnProfile) {
    Capture capture = ball_before_wall(0.7f, 3.3f);
    put_waves(capture);
    const std::string both = R"({ "default": )" + this->wide_ + R"(, "rows": [ { "object": 2, "profile": )" +
                             this->narrow_ + " } ] }";
    const auto with = [&](const std::string& profile) {
        return scattered(scattering_step(this->effect_, profile), capture);
    };
    expect_object_2_alone_is_narrow(capture, with(both), with(this->wide_), with(this->narrow_));
}
TYPED_TEST_P(ScatteringBlur, MixesByTheMask) {
    expect_the_mask_mixes(this->effect_, this->wide_);
}

REGISTER_TYPED_TEST_SUITE_P(ScatteringBlur, LetsNothingCrossSilhouettes, LeavesTheBitsOfWhatDoesNotScatter,
                            TakesEachObjectsProfile, KnowsTheWorldsUnit, LeavesLightThatIsNoNumberAlone,
                            LeavesEvenLightEven, KeepsTheEnergyOfLightFarInsideTheSilhouette,
                            ChangesTheHeadOfSuzanneAlone, LeavesObjectsThatDoNotScatterBitForBit,
                            ScattersEachObjectByItsOwnProfile, MixesByTheMask);

}  // namespace aftershade::test
