#include "framework/file/png_color.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "framework/base/text.h"
#include "framework/image/srgb.h"

namespace aftershade {

namespace {

using Bytes = std::span<const unsigned char>;

std::uint32_t number_at(Bytes bytes, std::size_t at) {
    return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
           std::uint32_t(bytes[at + 2]) << 8 | std::uint32_t(bytes[at + 3]);
}

/// ICC.1:2022, 4.6: signed, 16 bits of fraction.
double fixed_at(Bytes bytes, std::size_t at) {
    return double(std::int32_t(number_at(bytes, at))) / 65536;
}

/// Unpacked by zlib; what is larger than any profile in use is cut off.
std::vector<unsigned char> inflated(Bytes packed) {
    constexpr std::size_t kMostBytes = 8 * 1024 * 1024;
    std::vector<unsigned char> bytes;
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) return bytes;
    stream.next_in = const_cast<Bytef*>(packed.data());
    stream.avail_in = uInt(packed.size());
    int state = Z_OK;
    while (state == Z_OK && bytes.size() < kMostBytes) {
        const std::size_t had = bytes.size();
        bytes.resize(had + 64 * 1024);
        stream.next_out = bytes.data() + had;
        stream.avail_out = uInt(bytes.size() - had);
        state = inflate(&stream, Z_NO_FLUSH);
        bytes.resize(bytes.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    return bytes;
}

/// A tag's bytes; empty where the profile has none, or it reaches beyond the end.
Bytes tag_of(Bytes profile, std::string_view name) {
    constexpr std::size_t kTable = 128, kEntryBytes = 12;
    if (profile.size() < kTable + 4) return {};
    const std::size_t count = std::min<std::size_t>(number_at(profile, kTable), 100);
    for (std::size_t i = 0, at = kTable + 4; i < count && at + kEntryBytes <= profile.size();
         ++i, at += kEntryBytes) {
        const std::size_t begin = number_at(profile, at + 4), size = number_at(profile, at + 8);
        if (std::equal(name.begin(), name.end(), profile.begin() + std::ptrdiff_t(at)))
            return begin <= profile.size() && size <= profile.size() - begin ? profile.subspan(begin, size)
                                                                             : Bytes{};
    }
    return {};
}

bool has_type(Bytes tag, std::string_view type, std::size_t bytes) {
    return tag.size() >= bytes && std::equal(type.begin(), type.end(), tag.begin());
}

/// A curve at `x`, by ICC.1:2022, 10.6 and 10.18; nullopt of other types.
std::optional<double> curve_at(Bytes tag, double x) {
    if (has_type(tag, "curv", 12)) {
        const std::size_t count = number_at(tag, 8);
        if (count == 0) return x;
        if (count > (tag.size() - 12) / 2) return std::nullopt;
        const auto entry = [&](std::size_t i) { return double(tag[12 + 2 * i] << 8 | tag[13 + 2 * i]); };
        if (count == 1) return std::pow(x, entry(0) / 256);
        const double at = x * double(count - 1);
        const auto low = std::min(std::size_t(at), count - 2);
        return (entry(low) + (at - double(low)) * (entry(low + 1) - entry(low))) / 65535;
    }
    if (!has_type(tag, "para", 16)) return std::nullopt;
    const int function = tag[8] << 8 | tag[9];
    constexpr std::array<std::size_t, 5> kNumbers = {1, 3, 4, 5, 7};
    if (function > 4 || tag.size() < 12 + 4 * kNumbers[std::size_t(function)]) return std::nullopt;
    std::array<double, 7> p{1, 1, 0, 0, 0, 0, 0};  // g a b c d e f
    for (std::size_t i = 0; i < kNumbers[std::size_t(function)]; ++i) p[i] = fixed_at(tag, 12 + 4 * i);
    const auto [g, a, b, c, d, e, f] = p;
    if (function == 0) return std::pow(x, g);
    const double least = function <= 2 ? -b / a : d;
    if (x < least) return function <= 1 ? 0 : function == 2 ? c : function == 3 ? c * x : c * x + f;
    const double offset = function == 2 ? c : function == 4 ? e : 0;
    return std::pow(std::max(a * x + b, 0.0), g) + offset;
}

bool is_srgb_curve(Bytes tag) {
    // A power of 2.2 is within 0.008 of sRGB's curve; one of 1.8 or 2.4 is 0.02 or more away from both.
    constexpr double kTolerance = 0.009;
    return std::ranges::all_of(std::array{0.25, 0.5, 0.75}, [&](double x) {
        const auto light = curve_at(tag, x);
        return light && std::abs(*light - decode_srgb(x)) <= kTolerance;
    });
}

using Curve = ColorEncoding::Curve;

/// A row of ITU-T H.273, table 3.
struct CurveCode {
    int code;
    Curve curve;
    double gamma = 1;
};
/// BT.709's pictures are for the curve of BT.1886, a power of 2.4. The first of equal curves is written.
constexpr std::array kCurveCodes = {
    CurveCode{1, Curve::gamma, 2.4}, CurveCode{4, Curve::gamma, 2.2},  CurveCode{8, Curve::linear},
    CurveCode{13, Curve::srgb},      CurveCode{16, Curve::pq},         CurveCode{18, Curve::hlg},
    CurveCode{6, Curve::gamma, 2.4}, CurveCode{14, Curve::gamma, 2.4}, CurveCode{15, Curve::gamma, 2.4}};
/// Table 2.
constexpr std::array<std::pair<int, std::string_view>, 3> kPrimariesCodes = {
    {{1, "rec709"}, {9, "rec2020"}, {12, "p3d65"}}};

std::optional<ColorEncoding> encoding_of_cicp(Bytes data) {
    const auto primaries =
        std::ranges::find(kPrimariesCodes, int(data[0]), [](const auto& row) { return row.first; });
    const auto curve = std::ranges::find(kCurveCodes, int(data[1]), &CurveCode::code);
    // Only RGB of the full range.
    if (primaries == kPrimariesCodes.end() || curve == kCurveCodes.end() || data[2] != 0 || data[3] != 1)
        return std::nullopt;
    return ColorEncoding{*color_space_primaries(primaries->second), curve->curve, curve->gamma};
}

/// Chunks round.
Chromaticities nearest_primaries(const Chromaticities& primaries) {
    return color_space_primaries(name_of_primaries(primaries)).value_or(primaries);
}

}  // namespace

std::optional<std::pair<int, int>> cicp_of(const ColorEncoding& encoding) {
    const std::string name = name_of_primaries(encoding.primaries);
    for (const auto& [primaries, space] : kPrimariesCodes)
        for (const CurveCode& curve : kCurveCodes)
            // The curve of BT.709 stands for its own gamut and that of BT.2020.
            if (space == name && curve.curve == encoding.curve && curve.gamma == encoding.gamma &&
                (curve.code != 1 || primaries != 12))
                return std::pair(primaries, curve.code);
    return std::nullopt;
}

bool is_srgb_profile(Bytes profile) {
    constexpr std::size_t kColorSpace = 16;
    if (profile.size() < 132) return false;
    if (std::string_view(reinterpret_cast<const char*>(&profile[kColorSpace]), 4) == "GRAY")
        return is_srgb_curve(tag_of(profile, "kTRC"));
    // sRGB's primaries, adapted to D50 by Bradford's method (IEC 61966-2-1, annex F; ICC's own profiles).
    constexpr std::array<std::array<double, 3>, 3> kColorants = {
        {{0.4361, 0.2225, 0.0139}, {0.3851, 0.7169, 0.0971}, {0.1431, 0.0606, 0.7141}}};
    constexpr std::array<std::string_view, 3> kNames = {"rXYZ", "gXYZ", "bXYZ"},
                                              kCurves = {"rTRC", "gTRC", "bTRC"};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        const Bytes colorant = tag_of(profile, kNames[i]);
        if (!has_type(colorant, "XYZ ", 20) || !is_srgb_curve(tag_of(profile, kCurves[i]))) return false;
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(fixed_at(colorant, 8 + 4 * c) - kColorants[i][c]) > 0.002) return false;
    }
    // A table of colours counts before the three colorants.
    return tag_of(profile, "A2B0").empty();
}

void PngColorReader::read(const std::string& type, Bytes data) {
    if (type == "acTL") is_animated_ = true;
    else if (type == "IHDR" && data.size() > 8) bits_ = data[8];
    else if (type == "sRGB") has_srgb_ = true;
    else if (type == "pHYs" && data.size() == 9 && number_at(data, 0) > 0 && number_at(data, 4) > 0)
        pixel_aspect_ = float(double(number_at(data, 4)) / double(number_at(data, 0)));
    else if (type == "cICP" && data.size() == 4) {
        has_cicp_ = true;
        // ITU-T H.273: primaries of BT.709, sRGB's curve, RGB, full range.
        if (!std::ranges::equal(data, std::array<unsigned char, 4>{1, 13, 0, 1}))
            cicp_ = fmt::format("cICP {} {} {} {}", data[0], data[1], data[2], data[3]);
        of_cicp_ = encoding_of_cicp(data);
    } else if (type == "iCCP") {
        const auto end = std::ranges::find(data, 0);
        if (data.end() - end < 2) return;  // after the name a method, which is always zlib's
        has_icc_ = true;
        const std::vector<unsigned char> profile =
            inflated(data.subspan(std::size_t(end - data.begin()) + 2));
        if (is_srgb_profile(profile)) return;
        icc_ = fmt::format("ICC profile '{}' (checksum {:08x})", printable(std::string(data.begin(), end)),
                           crc32(0, profile.data(), uInt(profile.size())));
    } else if (type == "gAMA" && data.size() == 4 && number_at(data, 0) > 0) {
        // 45455 and what programs round it to.
        const double gamma = number_at(data, 0) / 1e5;
        if (std::abs(gamma * 2.2 - 1) > 0.01) gamma_ = gamma;
    } else if (type == "cHRM" && data.size() == 32) {
        constexpr std::array<double, 8> kSrgb = {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};
        bool is_srgb = true;
        // The white point comes first in the chunk.
        for (std::size_t i = 0; i < kSrgb.size(); ++i)
            of_chrm_[(i + 6) % kSrgb.size()] = float(number_at(data, 4 * i) / 1e5);
        std::string text = "primaries";
        for (std::size_t i = 0; i < kSrgb.size(); ++i) {
            is_srgb &= std::abs(number_at(data, 4 * i) / 1e5 - kSrgb[i]) <= 0.001;
            const std::size_t shown = 4 * ((i + 2) % kSrgb.size());  // the white point last
            text += fmt::format(" {:.4f}", number_at(data, shown) / 1e5);
        }
        if (!is_srgb) primaries_ = text;
    }
}

PngColor PngColorReader::color() const {
    PngColor color;
    color.is_animated = is_animated_;
    color.pixel_aspect = pixel_aspect_;
    color.bits = bits_;
    const auto take = [&](const std::string& space) {
        if (!space.empty()) color.space = space;
        return color;
    };
    if (has_cicp_) color.encoding = of_cicp_;
    if (has_cicp_) return take(cicp_);
    if (has_icc_ && !icc_.empty()) color.encoding.reset();
    if (has_icc_) return take(icc_);
    if (has_srgb_) return color;
    color.gamma = gamma_;
    if (gamma_) color.encoding = {kRec709, ColorEncoding::Curve::gamma, 1 / *gamma_};
    if (!primaries_.empty()) color.encoding->primaries = nearest_primaries(of_chrm_);
    return take(primaries_);
}

std::string PngColor::note_of_data() const {
    const std::string what = gamma ? fmt::format("gAMA {:.5g}", *gamma) : is_srgb() ? "" : space;
    return what.empty() ? ""
                        : "its " + what + " is not applied: the numbers of data are read as they are stored";
}

float encoded_as_srgb(float value, double gamma) {
    return float(encode_srgb(std::pow(double(value), 1 / gamma)));
}

}  // namespace aftershade
