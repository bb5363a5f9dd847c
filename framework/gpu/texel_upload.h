// Texels from the caller's memory into a texture.
#pragma once

#include <cstdint>
#include <span>

#include "framework/gpu/texel_place.h"

namespace aftershade::gpu {

/// `values` has `channels` values for each pixel, at most as many as the texture has; the other channels
/// become zero. Floats go into floats, integers into integers.
void upload_texels(const TexelPlace& place, std::span<const float> values, int channels);
void upload_texels(const TexelPlace& place, std::span<const std::uint32_t> values, int channels);

}  // namespace aftershade::gpu
