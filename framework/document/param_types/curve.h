// How finely shaders see curves.
#pragma once

namespace aftershade {

/// How many samples of a curve its texture holds, over the domain, both ends included. With d the domain's
/// length and h = d / 1023, the shader's value is the curve's but for at most h^2 / 8 times the largest
/// second derivative where it is smooth, at most h / 4 times the change of slope beside a corner, and
/// rounding to float; points nearer to each other than h may be passed over.
inline constexpr int kCurveSamples = 1024;

}  // namespace aftershade
