// The meaning of a PNG's samples: its colour chunks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "framework/image/color_encoding.h"

namespace aftershade {

/// PNG specification (third edition), 4.3: cICP before iCCP before sRGB before gAMA and cHRM. Without any,
/// the samples are sRGB.
struct PngColor {
    /// "sRGB"; else what only a colour management could show: "ICC profile 'P3' (checksum 1a2b3c4d)", "cICP 9
    /// 16 0 1", "primaries 0.7080 0.2920 ...".
    std::string space = "sRGB";
    /// The value of gAMA, where it differs from sRGB's and no other chunk counts: light is the sample to the
    /// power 1 / gamma.
    std::optional<double> gamma;
    /// How the samples are encoded, where that is known: not by an ICC profile other than sRGB's.
    std::optional<ColorEncoding> encoding = kSrgbDisplay;
    bool is_animated = false;  ///< there are further pictures
    float pixel_aspect = 1;    ///< width over height, by pHYs
    int bits = 8;              ///< of a sample
    bool is_srgb() const { return space == "sRGB"; }
    /// Says that a file which is read as data keeps its stored numbers: "its gAMA 1 is not applied: ...".
    /// "" for sRGB, and for a file without colour chunks.
    std::string note_of_data() const;
};

/// Gathers the chunks of one file.
class PngColorReader {
public:
    void read(const std::string& type, std::span<const unsigned char> data);
    PngColor color() const;

private:
    std::string cicp_, icc_, primaries_;
    std::optional<ColorEncoding> of_cicp_ = kSrgbDisplay;
    Chromaticities of_chrm_ = kRec709;
    std::optional<double> gamma_;
    bool has_cicp_ = false, has_icc_ = false, has_srgb_ = false, is_animated_ = false;
    float pixel_aspect_ = 1;
    int bits_ = 8;
};

/// The code points of ITU-T H.273 for the primaries and the curve, as the chunk cICP has them; nullopt where
/// there are none.
std::optional<std::pair<int, int>> cicp_of(const ColorEncoding& encoding);

/// Whether an ICC profile is that of sRGB: of a display, its three colorants and a curve that is sRGB's or
/// its approximation, a power of 2.2.
bool is_srgb_profile(std::span<const unsigned char> profile);

/// An encoded value of such a file, as sRGB encodes the same light.
float encoded_as_srgb(float value, double gamma);

}  // namespace aftershade
