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
        unknown,  ///< log, PQ, HLG: this program has no such curve
        data      ///< the numbers are not colours
    };
    Chromaticities primaries = kRec709;
    Curve curve = Curve::linear;
    double gamma = 1;

    bool is_light() const { return curve == Curve::linear; }
    bool is_color() const { return curve != Curve::unknown && curve != Curve::data; }
    bool operator==(const ColorEncoding&) const = default;
};

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

}  // namespace aftershade
