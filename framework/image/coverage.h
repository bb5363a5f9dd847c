// Pixels that something covers in part.
#pragma once

namespace aftershade {

/// The least normal half (glsl/coverage.glsl has the same). A smaller alpha, which filters leave, has lost
/// its digits: what is divided by it would be noise.
inline constexpr float kLeastAlpha = 6.103515625e-5f;

}  // namespace aftershade
