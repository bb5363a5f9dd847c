// PNG of 8 or 16 bits a channel.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "framework/file/png_color.h"
#include "framework/image/color_encoding.h"
#include "framework/image/image.h"

namespace aftershade {

/// Latin-1 text by keyword, as the PNG specification's chunk tEXt has it: a keyword of 1 to 79 characters.
using PngText = std::map<std::string, std::string>;

/// The information in a picture's chunks.
struct PngMeaning {
    std::optional<ColorEncoding> display{};  ///< none, or an unknown curve: false colours and measures
    float pixel_aspect = 1;                  ///< width over height; other than 1 in the chunk pHYs
    int bits = 8;                            ///< of a sample: 8 or 16
};

/// The bytes of a PNG of display-referred values in [0, 1], already encoded, of 1, 3 or 4 float channels:
/// round(255 * clamp(v)), or 65535 instead of 255, NaN as 0. A fourth channel is unassociated alpha. `name`
/// is what the Error(ErrorKind::output) of a picture that is too large begins with.
std::string encode_png(const std::string& name, const Image& display, const PngText& text = {},
                       const PngMeaning& meaning = {});

/// Writes these bytes. The file appears by rename from a temporary file in the same folder. Throws
/// Error(ErrorKind::output).
void write_png(const std::filesystem::path& path, const Image& display, const PngText& text = {},
               const PngMeaning& meaning = {});

/// The information in the chunks of a complete PNG; nullopt for any other file.
std::optional<PngColor> read_png_color(const std::filesystem::path& path);

/// Reads PNG of 8 or 16 bits into [0, 1] floats, 1 to 4 channels as stored; `color` gets what they mean.
/// Throws Error(ErrorKind::capture).
Image read_png(const std::filesystem::path& path, PngColor* color = nullptr);
/// The same, of bytes in memory; `name` stands for the path.
Image decode_png(const std::filesystem::path& name, std::string_view bytes, PngColor* color = nullptr);

}  // namespace aftershade
