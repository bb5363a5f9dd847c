#include "framework/gpu/texture_format.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <glad/gl.h>

namespace aftershade::gpu {

namespace {

struct FormatInfo {
    TextureFormat format;
    std::string_view name;
    int channels;
    int bytes;
    GlFormat gl;
};

constexpr std::array<FormatInfo, 13> kFormats = {{
    {TextureFormat::r8, "r8", 1, 1, {GL_R8, GL_RED, GL_FLOAT}},
    {TextureFormat::rg8, "rg8", 2, 2, {GL_RG8, GL_RG, GL_FLOAT}},
    {TextureFormat::rgba8, "rgba8", 4, 4, {GL_RGBA8, GL_RGBA, GL_FLOAT}},
    {TextureFormat::r16f, "r16f", 1, 2, {GL_R16F, GL_RED, GL_FLOAT}},
    {TextureFormat::rg16f, "rg16f", 2, 4, {GL_RG16F, GL_RG, GL_FLOAT}},
    {TextureFormat::rgba16f, "rgba16f", 4, 8, {GL_RGBA16F, GL_RGBA, GL_FLOAT}},
    {TextureFormat::r32f, "r32f", 1, 4, {GL_R32F, GL_RED, GL_FLOAT}},
    {TextureFormat::rg32f, "rg32f", 2, 8, {GL_RG32F, GL_RG, GL_FLOAT}},
    {TextureFormat::rgba32f, "rgba32f", 4, 16, {GL_RGBA32F, GL_RGBA, GL_FLOAT}},
    {TextureFormat::r32ui, "r32ui", 1, 4, {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT}},
    {TextureFormat::rg32ui, "rg32ui", 2, 8, {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT}},
    {TextureFormat::rgba32ui, "rgba32ui", 4, 16, {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT}},
    {TextureFormat::r32i, "r32i", 1, 4, {GL_R32I, GL_RED_INTEGER, GL_INT}},
}};

const FormatInfo& info(TextureFormat format) {
    const FormatInfo& result = kFormats[static_cast<std::size_t>(format)];
    assert(result.format == format);
    return result;
}

}  // namespace

std::optional<TextureFormat> parse_texture_format(std::string_view name) {
    const auto found =
        std::find_if(kFormats.begin(), kFormats.end(), [&](const FormatInfo& f) { return f.name == name; });
    if (found == kFormats.end()) return std::nullopt;
    return found->format;
}

std::string_view texture_format_name(TextureFormat format) {
    return info(format).name;
}

std::vector<std::string_view> texture_format_names() {
    std::vector<std::string_view> names;
    for (const FormatInfo& format : kFormats) names.push_back(format.name);
    return names;
}

int channel_count(TextureFormat format) {
    return info(format).channels;
}

int bytes_per_texel(TextureFormat format) {
    return info(format).bytes;
}

bool is_integer(TextureFormat format) {
    return format >= TextureFormat::r32ui;
}

bool is_signed_integer(TextureFormat format) {
    return format == TextureFormat::r32i;
}

GlFormat gl_format(TextureFormat format) {
    return info(format).gl;
}

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
