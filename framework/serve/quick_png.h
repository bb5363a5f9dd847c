// PNG for a page that shows a picture once: larger files than encode_png() makes, in a tenth of its time.
#pragma once

#include <string>

#include "framework/image/image.h"

namespace aftershade::serve {

/// The same pixels as encode_png(). `display` has 1, 3 or 4 float channels and is not empty.
std::string quick_png(const Image& display);

}  // namespace aftershade::serve
