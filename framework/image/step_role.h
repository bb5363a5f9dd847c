// Roles that steps output for later ones, and that no capture has.
#pragma once

#include <string_view>

namespace aftershade {

/// Light on a surface over that of the frame before, per channel; 1 where that is unknown. Alpha: frames that
/// the step averaged it over; 0 for none.
inline constexpr std::string_view kLightChangeRole = "light_change";

/// Light that a lens spreads over a pixel from surfaces in front of what the pixel shows, premultiplied, with
/// its opacity as alpha.
inline constexpr std::string_view kForegroundRole = "foreground";

/// Offsets from the pixel, px: to where most of `foreground` comes from (R, G), and to a pixel of the surface
/// behind the one that the pixel shows (B, A), if that surface is seen; else 0.
inline constexpr std::string_view kForegroundPlaceRole = "foreground_place";

/// Whether steps alone make images of this role. Where no step has made one, its pixels are the role's
/// `outside`.
bool is_step_role(std::string_view name);

}  // namespace aftershade
