// Pixels as text for a page that a browser opens without any other file.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "framework/image/image.h"

namespace aftershade {

/// RFC 4648 section 4, padded.
std::string base64(std::span<const std::byte> bytes);

struct PagePixels {
    std::string_view type;  ///< "half" where every value is one, else "float"; "uint"
    std::string text;
};

/// Every value of the image, exact: base64 of a zlib stream (RFC 1950) of planes. A plane has one byte of one
/// channel of every pixel, row by row, as its difference from the byte before (modulo 256, the first from 0);
/// planes are ordered by channel, then from the least significant byte. NaN keeps no payload as a half.
PagePixels page_pixels(const Image& image);

}  // namespace aftershade
