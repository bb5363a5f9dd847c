// The scattering profiles that are shipped, against what their sources say of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/scattering/scattering_profiles.h"

namespace aftershade {
namespace {

using test::Jensen;
using test::profile_of;

ScatteringProfile shipped(const std::string& name) {
    return profile_of("\"" + name + "\"");
}

TEST(ShippedScatteringProfiles, AreAllSound) {
    const auto names = scattering_profile_names();
    ASSERT_GE(names.size(), 15u);
    EXPECT_EQ(std::count(names.begin(), names.end(), "profile.schema"), 0);
    for (const std::string& name : names) {
        const ScatteringProfile profile = shipped(name);
        EXPECT_EQ(profile.name, name);
        for (int c = 0; c < 3; ++c) {
            EXPECT_GT(profile.mean_square_mm2(c), 0) << name;
            EXPECT_NEAR(profile.within(c, 1e4), 1, 1e-6) << name;
        }
    }
}

// The paper prints the diffuse reflectance beside the coefficients; it follows from them by the dipole's
// total, so that a coefficient that was copied wrongly shows. Its own two digits differ from that by 0.008 at
// most, but for one.
TEST(ShippedScatteringProfiles, OfJensensTableHaveThePublishedReflectance) {
    const std::map<std::string, Rgb> reflectances = {
        {"apple", {0.85, 0.84, 0.53}},  {"chicken1", {0.31, 0.15, 0.10}},  {"chicken2", {0.32, 0.16, 0.10}},
        {"cream", {0.98, 0.90, 0.73}},  {"ketchup", {0.16, 0.01, 0.00}},   {"marble", {0.83, 0.79, 0.75}},
        {"potato", {0.77, 0.62, 0.21}}, {"skim_milk", {0.81, 0.81, 0.69}}, {"skin1", {0.44, 0.22, 0.13}},
        {"skin2", {0.63, 0.44, 0.34}},  {"whole_milk", {0.91, 0.88, 0.76}}};
    for (const auto& [name, reflectance] : reflectances) {
        const ScatteringProfile profile = shipped(name);
        ASSERT_EQ(profile.type, ScatteringProfile::Type::dipole) << name;
        EXPECT_EQ(profile.ior, name == "marble" ? 1.5 : 1.3) << name;
        for (std::size_t c = 0; c < 3; ++c) {
            const Jensen jensen{profile.absorption[c], profile.scattering[c], profile.ior};
            const double bound = name == "chicken1" && c == 2 ? 0.027 : 0.0085;
            EXPECT_NEAR(jensen.total(), reflectance[c], bound) << name << " " << c;
        }
    }
}

TEST(ShippedScatteringProfiles, OfSkinAsBurleyAreAsWideAsTheirSources) {
    const ScatteringProfile six = shipped("skin"), one = shipped("skin_burley"),
                            unreal = shipped("skin_unreal");
    // 2.6748 mm times the path's colour, over 3.5 + 100 (albedo - 0.33)^4.
    const Rgb unreal_mm = {0.1800, 0.0680, 0.0551};
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(one.d_mm[c], six.fitted_d_mm()[c], 5e-5);
        EXPECT_NEAR(unreal.d_mm[c], unreal_mm[c], 1e-4);
    }
}

TEST(ShippedScatteringProfiles, OfTheArtistIsWhatNothingElseBeingSaidMeans) {
    const ScatteringProfile artist = shipped("skin_artist"), usual = profile_of(R"({"type": "artist"})");
    EXPECT_EQ(artist.gaussians, usual.gaussians);
    EXPECT_EQ(artist.direct, usual.direct);
}

}  // namespace
}  // namespace aftershade
