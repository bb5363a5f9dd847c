// Immutable-size textures with a debug label. Texel row 0 is the top row of the image.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "framework/gpu/context.h"
#include "framework/gpu/handle.h"
#include "framework/gpu/object_cache.h"
#include "framework/gpu/texel_read.h"
#include "framework/gpu/texture_format.h"

namespace aftershade::gpu {

/// [the context's thread]
class Texture {
public:
    /// Throws Error(ErrorKind::effect) when GL has no memory for it or a side exceeds GL_MAX_TEXTURE_SIZE.
    Texture(Context& context, const TextureDesc& desc, std::string label);
    /// The memory of `other` under a format with as many bytes a texel (asserted): each reads as bits what
    /// the other wrote. GL keeps the memory as long as one of them lives.
    Texture(const Texture& other, TextureFormat format, std::string label);

    const TextureDesc& desc() const { return desc_; }
    const std::string& label() const { return label_; }

    /// width * height * channel_count(format) values of one level and layer, rows from the top, channels
    /// interleaved.
    /// Values are numbers as a shader fetches them, whatever the format: floats that go into integers are
    /// rounded and kept in range, integers that go into floats keep their value. r32i as std::uint32_t is
    /// two's complement.
    /// `channels`: as many values a pixel, and the others are zero; 0: as many as the format has.
    void upload(std::span<const float> values, int layer = 0, int level = 0, int channels = 0);
    void upload(std::span<const std::uint32_t> values, int layer = 0, int level = 0);
    std::vector<float> read_floats(int level = 0, int layer = 0) const;
    /// Level 0 of an image, or of the first one: `channels` of each pixel; 0: as many as the format has.
    TexelRead begin_read(int channels = 0, ReadAs as = ReadAs::stored) const;
    std::vector<std::uint32_t> read_uints(int level = 0, int layer = 0) const;

    /// Every texel, every level and layer.
    void clear(float value);
    /// A value for each channel, as a shader would write it: rounded and kept in range for integers.
    void clear_to(const std::array<double, 4>& value);
    /// One level, and one layer of it; nullopt: every one.
    void clear_to(const std::array<double, 4>& value, std::optional<int> level, std::optional<int> layer);
    /// Fills levels 1.. from level 0 with GL's own box filter.
    void generate_mips();

    unsigned int handle() const { return handle_.name(); }                           ///< for framework/gpu
    CachedTexture cached() const { return {handle(), desc_.format, desc_.layers}; }  ///< for framework/gpu

private:
    TexelPlace place(int level, int layer) const;

    Handle<ObjectKind::texture> handle_;
    TextureDesc desc_;
    std::string label_;
};

}  // namespace aftershade::gpu
