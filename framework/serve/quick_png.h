// PNG for a page that shows a picture once: packed at the fastest level of zlib, where encode_png() packs for
// small files.
#pragma once

#include <string>

#include "framework/image/image.h"

namespace aftershade::serve {

/// The same pixels as encode_png(), and its chunk sRGB. `display` has 1, 3 or 4 float channels and is not
/// empty.
std::string quick_png(const Image& display, bool is_srgb);

}  // namespace aftershade::serve
