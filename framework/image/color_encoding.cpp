#include "framework/image/color_encoding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "framework/image/luminance.h"
#include "framework/image/srgb.h"

namespace aftershade {

namespace {

using Curve = ColorEncoding::Curve;

struct NamedPrimaries {
    std::string_view name;
    Chromaticities primaries;
};

/// As the Color Interop Forum abbreviates them; the first of equal ones is written.
const std::vector<NamedPrimaries>& primaries_of_ids() {
    static const std::vector<NamedPrimaries> all = {
        {"rec709", kRec709},
        {"ap1", *color_space_primaries("acescg")},
        {"ap0", *color_space_primaries("ap0")},
        {"rec2020", *color_space_primaries("rec2020")},
        {"p3d65", *color_space_primaries("p3d65")},
        // Adobe RGB (1998), version 2005-05.
        {"adobergb", {0.64f, 0.33f, 0.21f, 0.71f, 0.15f, 0.06f, 0.3127f, 0.3290f}},
        {"ciexyzd65", kXyz},
        {"xyzd65", kXyz},
    };
    return all;
}

struct NamedCurve {
    std::string_view name;
    Curve curve;
    double gamma = 1;
};
constexpr std::array kCurves = {
    NamedCurve{"lin", Curve::linear},     NamedCurve{"srgb", Curve::srgb},
    NamedCurve{"srgbe", Curve::srgb},     NamedCurve{"g18", Curve::gamma, 1.8},
    NamedCurve{"g22", Curve::gamma, 2.2}, NamedCurve{"g24", Curve::gamma, 2.4},
    NamedCurve{"g26", Curve::gamma, 2.6}, NamedCurve{"pq", Curve::unknown},
    NamedCurve{"hlg", Curve::unknown},    NamedCurve{"acescct", Curve::unknown},
    NamedCurve{"acescc", Curve::unknown},
};

/// Names without case and punctuation. From OpenImageIO's reserved names and the configurations of
/// OpenColorIO for ACES (1.0 to 2.0), Blender and CG.
constexpr std::array<std::pair<std::string_view, std::string_view>, 54> kOtherNames = {{
    {"acescg", "lin_ap1_scene"},
    {"acesacescg", "lin_ap1_scene"},
    {"linap1", "lin_ap1_scene"},
    {"linearap1", "lin_ap1_scene"},
    {"aces20651", "lin_ap0_scene"},
    {"acesaces20651", "lin_ap0_scene"},
    {"aces", "lin_ap0_scene"},
    {"linap0", "lin_ap0_scene"},
    {"lin709", "lin_rec709_scene"},
    {"linrec709", "lin_rec709_scene"},
    {"linsrgb", "lin_rec709_scene"},
    {"linearrec709", "lin_rec709_scene"},
    {"linearrec709srgb", "lin_rec709_scene"},
    {"linearsrgb", "lin_rec709_scene"},
    {"utilitylinearsrgb", "lin_rec709_scene"},
    {"utilitylinearrec709", "lin_rec709_scene"},
    {"linrec2020", "lin_rec2020_scene"},
    {"linearrec2020", "lin_rec2020_scene"},
    {"utilitylinearrec2020", "lin_rec2020_scene"},
    {"linp3d65", "lin_p3d65_scene"},
    {"linearp3d65", "lin_p3d65_scene"},
    {"lineardcip3d65", "lin_p3d65_scene"},
    {"utilitylinearp3d65", "lin_p3d65_scene"},
    {"linadobergb", "lin_adobergb_scene"},
    {"linearadobergb", "lin_adobergb_scene"},
    {"linciexyzd65", "lin_ciexyzd65_scene"},
    {"ciexyzd65", "lin_ciexyzd65_scene"},
    {"srgb", "srgb_rec709_scene"},
    {"srgbtexture", "srgb_rec709_scene"},
    {"utilitysrgbtexture", "srgb_rec709_scene"},
    {"srgbrec709", "srgb_rec709_scene"},
    {"srgbdisplay", "srgb_rec709_display"},
    {"srgbencodedrec709srgb", "srgb_rec709_scene"},
    {"srgbencodedap1texture", "srgb_ap1_scene"},
    {"srgbencodedap1", "srgb_ap1_scene"},
    {"srgbencodedp3d65", "srgb_p3d65_scene"},
    {"srgbencodedp3d65texture", "srgb_p3d65_scene"},
    {"gamma18", "g18_rec709_scene"},
    {"gamma22", "g22_rec709_scene"},
    {"gamma24", "g24_rec709_scene"},
    {"gamma18encodedrec709", "g18_rec709_scene"},
    {"gamma22encodedrec709", "g22_rec709_scene"},
    {"gamma24encodedrec709", "g24_rec709_scene"},
    {"gamma22encodedap1", "g22_ap1_scene"},
    {"gamma22encodedadobergb", "g22_adobergb_scene"},
    {"adobergb", "g22_adobergb_scene"},
    {"acescct", "acescct_ap1_scene"},
    {"acesacescct", "acescct_ap1_scene"},
    {"acescc", "acescc_ap1_scene"},
    {"acesacescc", "acescc_ap1_scene"},
    {"raw", "data"},
    {"utilityraw", "data"},
    {"noncolor", "data"},
    {"noncolordata", "data"},
}};

std::string plain(std::string_view name) {
    std::string letters;
    for (const char c : name) {
        if (c >= 'A' && c <= 'Z') letters += char(c - 'A' + 'a');
        else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) letters += c;
    }
    return letters;
}

/// "srgb_rec709_scene", whose last word says what the light is of, and does not alter the numbers.
std::optional<ColorEncoding> parse_id(std::string_view id) {
    if (id == "data") return ColorEncoding{kRec709, Curve::data, 1};
    for (const std::string_view state : {"_scene", "_display"})
        for (const NamedCurve& curve : kCurves)
            for (const NamedPrimaries& space : primaries_of_ids())
                if (id == std::string(curve.name) + "_" + std::string(space.name) + std::string(state))
                    return ColorEncoding{space.primaries, curve.curve, curve.gamma};
    return std::nullopt;
}

double decoded(double value, const ColorEncoding& encoding) {
    switch (encoding.curve) {
        case Curve::srgb: return decode_srgb(value);
        case Curve::rec709: return value < 0.081 ? value / 4.5 : std::pow((value + 0.099) / 1.099, 1 / 0.45);
        // A power of a number below 0 is none: it keeps its sign.
        case Curve::gamma: return std::copysign(std::pow(std::abs(value), encoding.gamma), value);
        default: return value;
    }
}

double encoded(double light, const ColorEncoding& encoding) {
    switch (encoding.curve) {
        case Curve::srgb: return encode_srgb(light);
        case Curve::rec709: return light < 0.018 ? light * 4.5 : 1.099 * std::pow(light, 0.45) - 0.099;
        case Curve::gamma: return std::copysign(std::pow(std::abs(light), 1 / encoding.gamma), light);
        default: return light;
    }
}

void apply_curve(Image& image, const ColorEncoding& encoding,
                 double (*curve)(double value, const ColorEncoding& encoding)) {
    if (encoding.is_light()) return;
    const std::span<float> values = image.floats();
    const auto channels = std::size_t(image.channels());
    for (std::size_t i = 0; i < values.size(); i += channels) {
        const double alpha = channels > 3 && values[i + 3] > 0 ? double(values[i + 3]) : 1;
        for (std::size_t c = 0; c < std::min<std::size_t>(channels, 3); ++c)
            values[i + c] = float(alpha * curve(double(values[i + c]) / alpha, encoding));
    }
}

}  // namespace

std::optional<ColorEncoding> find_color_encoding(std::string_view name) {
    std::string lower(name);
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    if (auto encoding = parse_id(lower)) return encoding;
    const std::string letters = plain(name);
    // OpenImageIO's name of BT.709's curve, which the forum has none for.
    if (letters == "rec709") return ColorEncoding{kRec709, Curve::rec709, 1};
    for (const auto& [other, id] : kOtherNames)
        if (letters == other) return parse_id(id);
    return std::nullopt;
}

std::string color_interop_id(const ColorEncoding& encoding) {
    const std::string name = name_of_primaries(encoding.primaries);
    for (const NamedCurve& curve : kCurves)
        for (const NamedPrimaries& space : primaries_of_ids()) {
            const bool has_name = !name.empty() && name == name_of_primaries(space.primaries);
            const bool is_curve = curve.curve == encoding.curve && curve.gamma == encoding.gamma;
            if ((has_name || encoding.primaries == space.primaries) && is_curve &&
                encoding.curve != Curve::unknown)
                return std::string(curve.name) + "_" + std::string(space.name) + "_scene";
        }
    return encoding.curve == Curve::data ? "data" : "";
}

void decode_curve(Image& image, const ColorEncoding& encoding) {
    apply_curve(image, encoding, decoded);
}

void encode_curve(Image& image, const ColorEncoding& encoding) {
    apply_curve(image, encoding, encoded);
}

namespace {

constexpr double kWhite_cd_m2 = 203;

/// SMPTE ST 2084:2014, 5.2, cd/m^2.
double pq_cd_m2(double value) {
    constexpr double kM1 = 2610.0 / 16384, kM2 = 2523.0 / 32, kC1 = 3424.0 / 4096, kC2 = 2413.0 / 128,
                     kC3 = 2392.0 / 128;
    const double root = std::pow(std::clamp(value, 0.0, 1.0), 1 / kM2);
    return 10000 * std::pow(std::max(root - kC1, 0.0) / (kC2 - kC3 * root), 1 / kM1);
}

/// The scene's light, ITU-R BT.2100-2, table 5.
double hlg_scene(double value) {
    constexpr double kA = 0.17883277, kB = 1 - 4 * kA, kC = 0.55991073;
    return value <= 0.5 ? value * value / 3 : (std::exp((value - kC) / kA) + kB) / 12;
}

constexpr double kHlgPeak_cd_m2 = 1000;

}  // namespace

double display_light(double value, const ColorEncoding& encoding) {
    const double seen = std::max(value, 0.0);
    if (encoding.curve == Curve::pq) return pq_cd_m2(seen) / kWhite_cd_m2;
    if (encoding.curve == Curve::hlg)
        return std::pow(hlg_scene(seen), kHlgGamma) * kHlgPeak_cd_m2 / kWhite_cd_m2;
    return decoded(seen, encoding);
}

void encode_display_as_srgb(Image& image, const ColorEncoding& encoding) {
    const ColorMatrix to_rec709 = conversion_matrix(encoding.primaries, kRec709);
    const ColorMatrix to_xyz = conversion_matrix(encoding.primaries, kXyz);
    const std::span<float> values = image.floats();
    const std::size_t stored = std::size_t(image.channels()), colors = stored < 3 ? 1 : 3;
    for (std::size_t i = 0; i < values.size(); i += stored) {
        std::array<double, 3> light{};
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = std::max(double(values[i + (colors == 1 ? 0 : c)]), 0.0);
            light[c] = encoding.curve == Curve::hlg ? hlg_scene(value) : display_light(value, encoding);
        }
        if (encoding.curve == Curve::hlg) {  // BT.2100's system gamma is of the luminance
            const double y = to_xyz[3] * light[0] + to_xyz[4] * light[1] + to_xyz[5] * light[2];
            const double factor = std::pow(std::max(y, 1e-9), kHlgGamma - 1) * kHlgPeak_cd_m2 / kWhite_cd_m2;
            for (double& channel : light) channel *= factor;
        }
        for (std::size_t row = 0; row < colors; ++row) {
            double converted = 0;
            for (std::size_t k = 0; k < 3; ++k) converted += to_rec709[row * 3 + k] * light[k];
            values[i + row] = float(encode_srgb(std::max(converted, 0.0)));
        }
    }
}

}  // namespace aftershade
