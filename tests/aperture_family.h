// What depth of field with an aperture of blades has in common where it keeps numbers as floats, as one
// suite. An effect's test names itself in a type and instantiates the suite with it:
//
//     struct Mine { static constexpr const char* kEffect = "mine"; };
//     INSTANTIATE_TYPED_TEST_SUITE_P(Mine, ApertureOfBlades, Mine);
#pragma once

#include <gtest/gtest.h>

#include "tests/aperture_checks.h"

namespace aftershade::test {

template <typename Named>
class ApertureOfBlades : public testing::Test {
protected:
    const std::string effect_ = Named::kEffect;
};
TYPED_TEST_SUITE_P(ApertureOfBlades);

TYPED_TEST_P(ApertureOfBlades, MakesOfAPointItsShape) {
    for (const AperturePoint& point :
         {AperturePoint{3, 8.2, 0, false}, AperturePoint{3, 24.2, 0, true}, AperturePoint{5, 8, 0, true},
          AperturePoint{5, 24, 11, false}, AperturePoint{6, 8, 0, false}, AperturePoint{6, 24.5, 30, true},
          AperturePoint{7, 8, 0, true}, AperturePoint{7, 33, 20, false}, AperturePoint{0, 20, 0, false},
          AperturePoint{6, 20, 0, true, 1}})
        expect_point_is_the_aperture(this->effect_, point);
}
TYPED_TEST_P(ApertureOfBlades, KeepsTheEnergyOfAPointAtAnyRadius) {
    for (const AperturePoint& point :
         {AperturePoint{6, 0.6, 0, false}, AperturePoint{5, 1.3, 0, true}, AperturePoint{0, 2.7, 0, false},
          AperturePoint{7, 5.1, 3, true}, AperturePoint{6, 60.2, 0, false},
          AperturePoint{5, 17.3, 8, true, 0.5}})
        expect_point_is_the_aperture(this->effect_, point);
}
TYPED_TEST_P(ApertureOfBlades, LeavesAUniformImageUnchanged) {
    expect_uniform_stays_uniform(this->effect_, "");
    expect_uniform_stays_uniform(this->effect_, R"("blades": 5, "rotation": 17, "curvature": 0.4)");
}
TYPED_TEST_P(ApertureOfBlades, CopiesPixelsInFocusBitForBit) {
    expect_focus_stays_bit_for_bit(this->effect_);
}
TYPED_TEST_P(ApertureOfBlades, KeepsAFocusedObjectOutOfTheBlurBehindIt) {
    expect_focus_leaks_at_most(this->effect_, 0.01f);
}
TYPED_TEST_P(ApertureOfBlades, BlursAlphaWithTheColorThatItCovers) {
    expect_alpha_blurs_with_color(this->effect_);
}
TYPED_TEST_P(ApertureOfBlades, GivesTheSameBitsOnBothSoftwareBackends) {
    expect_same_bits_on_both_backends(this->effect_);
}
TYPED_TEST_P(ApertureOfBlades, MakesNoLightAndNoNumberThatIsNone) {
    expect_no_light_is_made(this->effect_);
}

REGISTER_TYPED_TEST_SUITE_P(ApertureOfBlades, MakesOfAPointItsShape, KeepsTheEnergyOfAPointAtAnyRadius,
                            LeavesAUniformImageUnchanged, CopiesPixelsInFocusBitForBit,
                            KeepsAFocusedObjectOutOfTheBlurBehindIt, BlursAlphaWithTheColorThatItCovers,
                            GivesTheSameBitsOnBothSoftwareBackends, MakesNoLightAndNoNumberThatIsNone);

}  // namespace aftershade::test
