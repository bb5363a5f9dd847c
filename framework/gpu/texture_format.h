// Formats of textures.
#pragma once

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

}  // namespace aftershade::gpu
