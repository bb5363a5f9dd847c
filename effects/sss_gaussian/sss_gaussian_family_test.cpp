#include "tests/scattering_family.h"

namespace aftershade::test::sss_gaussian_family {
namespace {

struct Named {
    static constexpr const char* kEffect = "sss_gaussian";
    static constexpr const char* kWide = R"({ "type": "burley", "d_mm": [16, 12, 8] })";
    static constexpr const char* kNarrow = R"("skin")";
};

INSTANTIATE_TYPED_TEST_SUITE_P(SssGaussian, ScatteringBlur, Named);

}  // namespace
}  // namespace aftershade::test::sss_gaussian_family
