#include "framework/gpu/texel_place.h"

#include "framework/base/half_values.h"

namespace aftershade::gpu {
namespace {

/// Below, the bytes that are saved are not worth two more commands.
constexpr std::size_t kLeastHalfTexels = 16'384;

}  // namespace

int TexelPlace::width() const {
    return std::max(1, desc.width >> level);
}

int TexelPlace::height() const {
    return std::max(1, desc.height >> level);
}

std::size_t TexelPlace::texel_count() const {
    return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
}

bool TexelPlace::may_be_halfs() const {
    return desc.format == TextureFormat::rgba32f && texel_count() >= kLeastHalfTexels && converts_halfs();
}

}  // namespace aftershade::gpu
