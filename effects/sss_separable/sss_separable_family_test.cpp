// What all effects that scatter irradiance have in common.
#include <gtest/gtest.h>

#include "tests/scattering_checks.h"

namespace aftershade::test {
namespace {

constexpr const char* kEffect = "sss_separable";

TEST(SssSeparable, LetsNothingCrossSilhouettes) {
    expect_nothing_crosses_silhouettes(kEffect, "");
}
TEST(SssSeparable, LeavesTheBitsOfWhatDoesNotScatter) {
    expect_the_rest_keeps_its_bits(kEffect, "");
}
TEST(SssSeparable, TakesEachObjectsProfile) {
    expect_profiles_by_object(kEffect, "");
}
TEST(SssSeparable, KnowsTheWorldsUnit) {
    expect_world_unit_scales(kEffect, "");
}
TEST(SssSeparable, LeavesLightThatIsNoNumberAlone) {
    expect_no_number_stays_alone(kEffect, "");
}
TEST(SssSeparable, LeavesEvenLightEven) {
    expect_even_light_stays(kEffect, "", 1e-3);
}
TEST(SssSeparable, KeepsTheEnergyOfLightFarInsideTheSilhouette) {
    expect_energy_kept(kEffect, "", 0.005);
}
TEST(SssSeparable, ChangesTheHeadOfSuzanneAlone) {
    expect_the_head_of_suzanne_alone_changes(kEffect, "");
}

}  // namespace
}  // namespace aftershade::test
