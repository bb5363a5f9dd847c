// Values that are no finite numbers.
#pragma once

#include <limits>

namespace aftershade::test {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace aftershade::test
