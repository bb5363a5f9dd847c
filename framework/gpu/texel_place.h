// One level and layer of a texture, whose texels are uploaded or read. But for TexelPlace itself, internal to
// framework/gpu.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

#include "framework/gpu/context.h"
#include "framework/gpu/texture_format.h"

namespace aftershade::gpu {

/// [refers to what the caller keeps]
struct TexelPlace {
    Context& context;
    unsigned int texture = 0;
    const TextureDesc& desc;
    const std::string& label;
    int level = 0;
    int layer = 0;

    int width() const;
    int height() const;
    std::size_t texel_count() const;
    std::size_t stored_channels() const { return static_cast<std::size_t>(channel_count(desc.format)); }
    /// Whether texels are values of four bytes in client memory, so that no driver converts them, each in its
    /// way.
    bool is_unconverted() const { return bytes_per_texel(desc.format) == 4 * channel_count(desc.format); }
    /// Whether they may travel as halfs (half_kernels.h).
    bool may_be_halfs() const;
};

/// Pixels whose floats and halfs lie in a core's first cache together.
inline constexpr std::size_t kHalfBlock = 512;

/// The first channels of each pixel, the others zero: in either direction.
template <typename Value>
void copy_channels(const Value* from, std::size_t from_channels, Value* to, std::size_t to_channels,
                   std::size_t pixels) {
    if (from_channels == to_channels) {
        std::memcpy(to, from, pixels * to_channels * sizeof(Value));
        return;
    }
    const std::size_t common = std::min(from_channels, to_channels);
    for (std::size_t i = 0; i < pixels; ++i) {
        std::copy_n(from + i * from_channels, common, to + i * to_channels);
        std::fill_n(to + i * to_channels + common, to_channels - common, Value{});
    }
}

}  // namespace aftershade::gpu
