// Roles that steps output for later ones, and that no capture has.
#pragma once

#include <string_view>

namespace aftershade {

/// Light on a surface over that of the frame before, per channel; 1 where that is unknown. Alpha: frames that
/// the step averaged it over; 0 for none.
inline constexpr std::string_view kLightChangeRole = "light_change";

}  // namespace aftershade
