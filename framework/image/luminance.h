// Numbers of standards that more than one file needs for the luminance of colours.
#pragma once

#include <array>

namespace aftershade {

/// Shares of R, G and B in the luminance of ITU-R BT.709's primaries.
inline constexpr std::array<double, 3> kRec709Luminance = {0.2126, 0.7152, 0.0722};

/// To this power an HLG display of 1000 cd/m^2 raises the scene's luminance: ITU-R BT.2100-2, table 5.
inline constexpr double kHlgGamma = 1.2;

}  // namespace aftershade
