// How finely shaders see curves.
#pragma once

namespace aftershade {

/// Number of samples of a curve in its texture, over the domain, both ends included. Let d be the domain's
/// length and h = d / 1023. Where the curve is smooth, the shader's error is at most h^2 / 8 times the
/// largest second derivative. Beside a corner it is at most h / 4 times the change of slope. Rounding to
/// float is added, and points closer to each other than h may be missed.
inline constexpr int kCurveSamples = 1024;

}  // namespace aftershade
