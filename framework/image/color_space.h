// Primaries of scene-linear RGB and conversion between them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/image/image.h"

namespace aftershade {

/// CIE xy of red, green, blue and white, as EXR's attribute `chromaticities`.
using Chromaticities = std::array<float, 8>;

/// ITU-R BT.709.
inline constexpr Chromaticities kRec709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

/// CIE XYZ: what is called X, Y and Z is stored as red, green and blue.
inline constexpr Chromaticities kXyz = {1, 0, 0, 1, 0, 0, 1.0f / 3, 1.0f / 3};

/// Row by row: out = matrix * rgb.
using ColorMatrix = std::array<double, 9>;

/// "rec709", "acescg", "ap0", "rec2020", "p3d65"; nullopt for anything else.
std::optional<Chromaticities> color_space_primaries(std::string_view name);
std::vector<std::string> color_space_names();
/// The name of known primaries, to 0.0005 a coordinate; "" for others.
std::string name_of_primaries(const Chromaticities& primaries);

/// CIE XYZ stored as RGB: its values are absolute, so nothing is adapted to another white.
bool is_xyz(const Chromaticities& primaries);

/// From light in one space to the same light in another. Whites that differ are adapted by Bradford's method
/// (ICC v4, annex E). Throws Error(ErrorKind::capture) for primaries that span no space.
ColorMatrix conversion_matrix(const Chromaticities& from, const Chromaticities& to);

/// Shares of R, G and B in the luminance, Y of CIE 1931.
std::array<double, 3> luminance_weights(const Chromaticities& primaries);

/// Applies the matrix to the first three channels.
void convert_colors(Image& image, const ColorMatrix& matrix);

}  // namespace aftershade
