#include "framework/gpu/texture_desc.h"

#include <algorithm>

namespace aftershade::gpu {

bool may_share_memory(const TextureDesc& a, const TextureDesc& b) {
    TextureDesc as_b = a;
    as_b.format = b.format;
    return as_b == b && bytes_per_texel(a.format) == bytes_per_texel(b.format);
}

std::uint64_t byte_size(const TextureDesc& desc) {
    std::uint64_t texels = 0;
    for (int level = 0; level < desc.mips; ++level) {
        texels += static_cast<std::uint64_t>(std::max(1, desc.width >> level)) *
                  static_cast<std::uint64_t>(std::max(1, desc.height >> level));
    }
    return texels * static_cast<std::uint64_t>(desc.layers) *
           static_cast<std::uint64_t>(bytes_per_texel(desc.format));
}

}  // namespace aftershade::gpu
