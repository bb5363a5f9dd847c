// The tone mappers of HDR-FLIP.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aftershade {

enum class ToneMapper { aces, reinhard, hable };
std::string_view tone_mapper_name(ToneMapper mapper);
std::optional<ToneMapper> find_tone_mapper(std::string_view name);
std::vector<std::string> tone_mapper_names();

/// a0 to a5 of (x (x a0 + a1) + a2) / (x (x a3 + a4) + a5): ACES (Narkowicz's fit, its exposure of 0.6 taken
/// out) and Hable. Reinhard divides by luminance and has none.
const std::array<float, 6>& tone_mapper_coefficients(ToneMapper mapper);

}  // namespace aftershade
