// How an image file stores a channel.
#pragma once

#include <string_view>

namespace aftershade {

enum class PixelType { half, float32, uint32 };
std::string_view pixel_type_name(PixelType type);  ///< "half", "float", "uint"

}  // namespace aftershade
