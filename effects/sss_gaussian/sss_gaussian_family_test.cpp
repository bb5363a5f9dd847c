// What all effects that scatter irradiance have in common.
#include <gtest/gtest.h>

#include "tests/scattering_checks.h"

namespace aftershade::test {
namespace {

constexpr const char* kEffect = "sss_gaussian";

TEST(SssGaussian, LetsNothingCrossSilhouettes) {
    expect_nothing_crosses_silhouettes(kEffect, "");
}
TEST(SssGaussian, LeavesTheBitsOfWhatDoesNotScatter) {
    expect_the_rest_keeps_its_bits(kEffect, "");
}
TEST(SssGaussian, TakesEachObjectsProfile) {
    expect_profiles_by_object(kEffect, "");
}
TEST(SssGaussian, KnowsTheWorldsUnit) {
    expect_world_unit_scales(kEffect, "");
}
TEST(SssGaussian, LeavesLightThatIsNoNumberAlone) {
    expect_no_number_stays_alone(kEffect, "");
}
TEST(SssGaussian, LeavesEvenLightEven) {
    expect_even_light_stays(kEffect, "", 1e-3);
}
TEST(SssGaussian, KeepsTheEnergyOfLightFarInsideTheSilhouette) {
    expect_energy_kept(kEffect, "", 0.005);
}
TEST(SssGaussian, ChangesTheHeadOfSuzanneAlone) {
    expect_the_head_of_suzanne_alone_changes(kEffect, "");
}

}  // namespace
}  // namespace aftershade::test
