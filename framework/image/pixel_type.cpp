#include "framework/image/pixel_type.h"

namespace aftershade {

std::string_view pixel_type_name(PixelType type) {
    switch (type) {
        case PixelType::half: return "half";
        case PixelType::float32: return "float";
        case PixelType::uint32: return "uint";
    }
    return "unknown";
}

}  // namespace aftershade
