#include "tests/scattering_family.h"

namespace aftershade::test::sss_separable_family {
namespace {

struct Named {
    static constexpr const char* kEffect = "sss_separable";
    static constexpr const char* kWide = R"({ "type": "burley", "d_mm": [18, 18, 18] })";
    static constexpr const char* kNarrow = R"({ "type": "burley", "d_mm": [4, 4, 4] })";
};

INSTANTIATE_TYPED_TEST_SUITE_P(SssSeparable, ScatteringBlur, Named);

}  // namespace
}  // namespace aftershade::test::sss_separable_family
