// Formats of textures, and what else a texture is made of.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace aftershade::gpu {

enum class TextureFormat {
    r8,
    rg8,
    rgba8,  // unsigned normalised
    r16f,
    rg16f,
    rgba16f,  // half
    r32f,
    rg32f,
    rgba32f,  // float
    r32ui,
    rg32ui,
    rgba32ui,
    r32i  // integer
};

/// "rgba16f" and so on, as manifests spell them. Three-channel formats do not exist: llvmpipe refuses half
/// ones.
std::optional<TextureFormat> parse_texture_format(std::string_view name);
std::string_view texture_format_name(TextureFormat format);
std::vector<std::string_view> texture_format_names();
int channel_count(TextureFormat format);
int bytes_per_texel(TextureFormat format);
bool is_integer(TextureFormat format);  ///< sampled through usampler2D or isampler2D
bool is_signed_integer(TextureFormat format);

/// What GL calls a format; for framework/gpu.
struct GlFormat {
    unsigned int internal = 0;  ///< GL_RGBA32F, ...
    unsigned int pixel = 0;     ///< GL_RGBA, GL_RED_INTEGER, ...
    unsigned int type = 0;      ///< GL_FLOAT, ...: of four bytes in client memory that keep each value
};

GlFormat gl_format(TextureFormat format);

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
