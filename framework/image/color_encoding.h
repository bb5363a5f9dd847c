// How files store colours: primaries, and the curve between light and stored numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "framework/image/color_space.h"
#include "framework/image/image.h"

namespace aftershade {

struct ColorEncoding {
    enum class Curve {
        linear,
        srgb,     ///< IEC 61966-2-1
        rec709,   ///< ITU-R BT.709's camera curve
        gamma,    ///< light is the number to the power of `gamma`
        pq,       ///< SMPTE ST 2084, of displays
        hlg,      ///< hybrid log-gamma of ITU-R BT.2100, on a display of 1000 cd/m^2
        unknown,  ///< such as a logarithm: this program has no such curve
        data      ///< the numbers are not colours
    };
    Chromaticities primaries = kRec709;
    Curve curve = Curve::linear;
    double gamma = 1;

    /// Whether a display shows more than diffuse white.
    bool is_hdr() const { return curve == Curve::pq || curve == Curve::hlg; }
    bool is_light() const { return curve == Curve::linear; }
    bool is_color() const { return curve != Curve::unknown && curve != Curve::data; }
    bool operator==(const ColorEncoding&) const = default;
};

/// The display of IEC 61966-2-1.
inline constexpr ColorEncoding kSrgbDisplay{kRec709, ColorEncoding::Curve::srgb, 1};

/// By a name of the Color Interop Forum ("lin_ap1_scene", "g22_rec709_scene", "data"), or one that
/// OpenImageIO and OpenColorIO's usual configurations have for the same ("ACEScg", "Linear Rec.2020"); case
/// and punctuation make no difference. nullopt for others, and for "linear" and "scene_linear", which name no
/// primaries.
std::optional<ColorEncoding> find_color_encoding(std::string_view name);

/// The Color Interop Forum's name of an encoding: "lin_ap1_scene"; "" where it has none.
std::string color_interop_id(const ColorEncoding& encoding);

/// From stored numbers to light and back, of the first three channels. A fourth is alpha: colours are divided
/// by it before the curve and multiplied after, as OpenImageIO does. The curve must be one that this program
/// has.
void decode_curve(Image& image, const ColorEncoding& encoding);
void encode_curve(Image& image, const ColorEncoding& encoding);

/// Light of a grey on a display: 1 is its white; of PQ and HLG it is 203 cd/m^2, ITU-R BT.2408's white.
double display_light(double value, const ColorEncoding& encoding);

/// The colours of a picture for a display, of 1 to 4 channels, as sRGB encodes that light: above 1 where it
/// is brighter than white. Values below 0 count as 0. A known curve.
void encode_display_as_srgb(Image& image, const ColorEncoding& encoding);

}  // namespace aftershade
