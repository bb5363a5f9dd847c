// What a texture is made of.
#pragma once

#include <cstdint>

#include "framework/gpu/texture_format.h"

namespace aftershade::gpu {

struct TextureDesc {
    int width = 0;
    int height = 0;
    TextureFormat format = TextureFormat::rgba32f;
    int layers = 1;  ///< > 1 makes a 2-D array
    int mips = 1;
    bool operator==(const TextureDesc&) const = default;
};

/// Whether one may be a view of the other's memory: they differ by no more than a format of as many bytes a
/// texel. GL's classes of view-compatible formats are those of equal size, for the formats above.
bool may_share_memory(const TextureDesc& a, const TextureDesc& b);

/// Bytes that the texture's texels take, all layers and levels.
std::uint64_t byte_size(const TextureDesc& desc);

}  // namespace aftershade::gpu
