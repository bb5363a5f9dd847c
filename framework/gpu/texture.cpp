#include "framework/gpu/texture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/base/half_values.h"
#include "framework/gpu/context_internal.h"
#include "framework/gpu/half_kernels.h"
#include "framework/gpu/texel_place.h"
#include "framework/gpu/texture_format.h"

namespace aftershade::gpu {

namespace {

// Texels from the caller's memory into a texture.

/// `values` is memory, or an offset into the buffer that GL unpacks from.
void sub_image(const TexelPlace& place, int row, int rows, const void* values) {
    const GladGLContext& gl = place.context.gl();
    const auto [internal, pixel, type] = gl_format(place.desc.format);
    if (place.desc.layers > 1) {
        gl.TextureSubImage3D(place.texture, place.level, 0, row, place.layer, place.width(), rows, 1, pixel,
                             type, values);
    } else {
        gl.TextureSubImage2D(place.texture, place.level, 0, row, place.width(), rows, pixel, type, values);
    }
}

/// Whether all values are halfs; `halfs` gets four of each pixel.
bool pack_exact(const float* from, std::size_t channels, std::uint16_t* halfs, std::size_t pixels) {
    std::array<float, 4 * kHalfBlock> block;
    for (std::size_t i = 0; i < pixels; i += kHalfBlock) {
        const std::size_t count = std::min(kHalfBlock, pixels - i);
        const float* values = from + i * channels;
        if (channels != 4) {
            copy_channels(values, channels, block.data(), 4, count);
            values = block.data();
        }
        if (!to_exact_halfs(values, halfs + 4 * i, 4 * count)) return false;
    }
    return true;
}

/// The row before which all were halfs, and went.
int upload_halfs(const TexelPlace& place, std::span<const float> values, std::size_t channels) {
    Context::Impl& impl = place.context.impl();
    const auto width = static_cast<std::size_t>(place.width());
    const std::size_t row_bytes = width * 4 * sizeof(std::uint16_t);
    int row = 0;
    while (row < place.height()) {
        const float* const from = &values[static_cast<std::size_t>(row) * width * channels];
        // Most pictures that are no halfs show it at once, without a piece.
        std::array<std::uint16_t, 4 * kHalfBlock> first;
        if (!pack_exact(from, channels, first.data(), std::min(width, kHalfBlock))) break;
        const auto left = static_cast<std::size_t>(place.height() - row);
        const auto piece = impl.transfers->to_write(row_bytes, row_bytes * left);
        if (!piece) break;
        const std::size_t rows = piece->memory.size() / row_bytes;
        auto* const to = reinterpret_cast<std::uint16_t*>(piece->memory.data());
        std::atomic<bool> are_halfs = true;
        impl.transfers->share_out(rows * width, row_bytes / width, [&](std::size_t begin, std::size_t end) {
            if (are_halfs && !pack_exact(from + begin * channels, channels, to + 4 * begin, end - begin))
                are_halfs = false;
        });
        if (!are_halfs) break;
        half_kernels(place.context).unpack(*piece, place, {row, static_cast<int>(rows)});
        row += static_cast<int>(rows);
    }
    return row;
}

/// The row before which all went, from `row` on.
template <typename Value>
int upload_mapped(const TexelPlace& place, std::span<const Value> values, std::size_t channels, int row) {
    Context::Impl& impl = place.context.impl();
    const std::size_t stored = place.stored_channels();
    const auto width = static_cast<std::size_t>(place.width());
    const std::size_t row_bytes = width * stored * sizeof(Value);
    while (row < place.height()) {
        const auto left = static_cast<std::size_t>(place.height() - row);
        const auto piece = impl.transfers->to_write(row_bytes, row_bytes * left);
        if (!piece) break;
        const std::size_t rows = piece->memory.size() / row_bytes;
        const Value* const from = &values[static_cast<std::size_t>(row) * width * channels];
        auto* const to = reinterpret_cast<Value*>(piece->memory.data());
        impl.transfers->share_out(
            rows * width, stored * sizeof(Value), [&](std::size_t begin, std::size_t end) {
                copy_channels(from + begin * channels, channels, to + begin * stored, stored, end - begin);
            });
        impl.gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, piece->buffer->name);
        sub_image(place, row, static_cast<int>(rows), reinterpret_cast<void*>(piece->offset));
        impl.gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
        row += static_cast<int>(rows);
    }
    return row;
}

template <typename Value>
void upload(const TexelPlace& place, std::span<const Value> values, int channels) {
    const auto from = static_cast<std::size_t>(channels);
    const std::size_t stored = place.stored_channels();
    assert(values.size() == place.texel_count() * from && from <= stored);
    place.context.make_current();
    Context::Impl& impl = place.context.impl();
    impl.wait_for_draws();
    const Transfers::Timed timed(*impl.transfers, &TransferUse::upload_ms);
    int row = 0;
    if (impl.transfers->is_mapped() && place.is_unconverted()) {
        if constexpr (std::is_same_v<Value, float>)
            if (place.may_be_halfs()) row = upload_halfs(place, values, from);
        row = upload_mapped(place, values, from, row);
    }
    if (row < place.height()) {
        std::vector<Value> widened;
        auto rest =
            values.subspan(static_cast<std::size_t>(row) * static_cast<std::size_t>(place.width()) * from);
        if (from != stored) {
            widened.resize(rest.size() / from * stored);
            copy_channels(rest.data(), from, widened.data(), stored, rest.size() / from);
            rest = widened;
        }
        sub_image(place, row, place.height() - row, rest.data());
    }
    place.context.check(fmt::format("uploading texture '{}'", place.label));
}

/// `values` has `channels` values for each pixel, at most as many as the texture has; the other channels
/// become zero. Floats go into floats, integers into integers.
void upload_texels(const TexelPlace& place, std::span<const float> values, int channels) {
    assert(!is_integer(place.desc.format));
    upload(place, values, channels);
}

void upload_texels(const TexelPlace& place, std::span<const std::uint32_t> values, int channels) {
    assert(is_integer(place.desc.format));
    upload(place, values, channels);
}

/// The nearest integer that Integer holds; 0 for NaN.
template <typename Integer>
Integer to_integer(double value) {
    constexpr double kLow = std::numeric_limits<Integer>::min();
    constexpr double kHigh = std::numeric_limits<Integer>::max();
    if (std::isnan(value)) return 0;
    return static_cast<Integer>(std::clamp(std::nearbyint(value), kLow, kHigh));
}

/// A clear value in client memory of GlFormat::type: four channels of four bytes, whatever they mean.
std::array<std::uint32_t, 4> clear_texel(const std::array<double, 4>& value, TextureFormat format) {
    std::array<std::uint32_t, 4> texel{};
    for (std::size_t i = 0; i < texel.size(); ++i) {
        if (!is_integer(format)) {
            texel[i] = std::bit_cast<std::uint32_t>(static_cast<float>(value[i]));
        } else if (is_signed_integer(format)) {
            texel[i] = static_cast<std::uint32_t>(to_integer<std::int32_t>(value[i]));
        } else {
            texel[i] = to_integer<std::uint32_t>(value[i]);
        }
    }
    return texel;
}

template <typename To, typename From, typename Convert>
std::vector<To> converted(std::span<const From> values, Convert convert) {
    std::vector<To> result(values.size());
    std::transform(values.begin(), values.end(), result.begin(), convert);
    return result;
}

float from_bits(std::uint32_t value, TextureFormat format) {
    return is_signed_integer(format) ? static_cast<float>(static_cast<std::int32_t>(value))
                                     : static_cast<float>(value);
}

std::uint32_t to_bits(float value, TextureFormat format) {
    return is_signed_integer(format) ? static_cast<std::uint32_t>(to_integer<std::int32_t>(value))
                                     : to_integer<std::uint32_t>(value);
}

int level_side(int side, int level) {
    return std::max(1, side >> level);
}

void check_desc(const Limits& limits, const TextureDesc& desc, const std::string& label) {
    if (desc.width < 1 || desc.height < 1 || std::max(desc.width, desc.height) > limits.texture_size) {
        throw Error(ErrorKind::effect,
                    fmt::format("texture '{}': {}x{} texels; each side must be 1 to {} (GL_MAX_TEXTURE_SIZE)",
                                label, desc.width, desc.height, limits.texture_size));
    }
    if (desc.layers < 1 || desc.layers > limits.array_layers) {
        throw Error(
            ErrorKind::effect,
            fmt::format("texture '{}': {} layers; there must be 1 to {} (GL_MAX_ARRAY_TEXTURE_LAYERS)", label,
                        desc.layers, limits.array_layers));
    }
    const int most = std::bit_width(static_cast<unsigned>(std::max(desc.width, desc.height)));
    if (desc.mips < 1 || desc.mips > most) {
        throw Error(ErrorKind::effect, fmt::format("texture '{}': {} mip levels; {}x{} texels have 1 to {}",
                                                   label, desc.mips, desc.width, desc.height, most));
    }
}

GLuint make_storage(const GladGLContext& gl, const TextureDesc& desc) {
    GLuint handle = 0;
    const GLenum internal = gl_format(desc.format).internal;
    if (desc.layers > 1) {
        gl.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &handle);
        gl.TextureStorage3D(handle, desc.mips, internal, desc.width, desc.height, desc.layers);
    } else {
        gl.CreateTextures(GL_TEXTURE_2D, 1, &handle);
        gl.TextureStorage2D(handle, desc.mips, internal, desc.width, desc.height);
    }
    return handle;
}

GLuint make_view(const GladGLContext& gl, unsigned int of, const TextureDesc& desc,
                 const std::string& label) {
    GLuint handle = 0;
    gl.GenTextures(1, &handle);
    const GLenum target = desc.layers > 1 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
    gl.TextureView(handle, target, of, gl_format(desc.format).internal, 0, static_cast<GLuint>(desc.mips), 0,
                   static_cast<GLuint>(desc.layers));
    set_label(gl, GL_TEXTURE, handle, label);
    return handle;
}

/// Whether a draw stores the bits that a clear of memory does: what is no half, llvmpipe rounds to another
/// one.
bool is_stored_alike(const TextureDesc& desc, const std::array<double, 4>& value) {
    return bytes_per_texel(desc.format) == 4 * channel_count(desc.format) ||
           std::ranges::all_of(value, [](double v) { return v == 0.0 || v == 1.0; });
}

/// Clears as a draw, in order with the other draws.
void clear_drawn(const GladGLContext& gl, GLuint framebuffer, const TextureDesc& desc,
                 const std::array<std::uint32_t, 4>& texel) {
    if (!is_integer(desc.format)) {
        const auto values = std::bit_cast<std::array<GLfloat, 4>>(texel);
        gl.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, values.data());
    } else if (is_signed_integer(desc.format)) {
        const auto values = std::bit_cast<std::array<GLint, 4>>(texel);
        gl.ClearNamedFramebufferiv(framebuffer, GL_COLOR, 0, values.data());
    } else {
        gl.ClearNamedFramebufferuiv(framebuffer, GL_COLOR, 0, texel.data());
    }
}

template <typename Value>
std::vector<Value> read_values(const TexelPlace& place) {
    const int channels = channel_count(place.desc.format);
    std::vector<Value> values(place.texel_count() * static_cast<std::size_t>(channels));
    TexelRead(place, channels).finish(std::span(values));
    return values;
}

}  // namespace

template <>
void Handle<ObjectKind::texture>::remove(Context& context, unsigned int name) noexcept {
    if (!context.impl().try_make_current()) return;
    context.impl().cache->forget_texture(name);
    context.gl().DeleteTextures(1, &name);
}

Texture::Texture(Context& context, const TextureDesc& desc, std::string label)
    : desc_(desc), label_(std::move(label)) {
    context.make_current();
    check_desc(context.impl().limits, desc, label_);
    handle_ = Handle<ObjectKind::texture>(context, make_storage(context.gl(), desc));
    context.check(fmt::format("texture '{}', {}x{} {}, {} MiB", label_, desc.width, desc.height,
                              texture_format_name(desc.format), byte_size(desc) >> 20));
    set_label(context.gl(), GL_TEXTURE, handle(), label_);
}

Texture::Texture(const Texture& other, TextureFormat format, std::string label)
    : desc_(other.desc_), label_(std::move(label)) {
    desc_.format = format;
    assert(may_share_memory(desc_, other.desc_));
    Context& context = other.handle_.context();
    context.make_current();
    handle_ = Handle<ObjectKind::texture>(context, make_view(context.gl(), other.handle(), desc_, label_));
    context.check(
        fmt::format("texture '{}', a view of '{}' as {}", label_, other.label_, texture_format_name(format)));
}

TexelPlace Texture::place(int level, int layer) const {
    return {handle_.context(), handle(), desc_, label_, level, layer};
}

void Texture::upload(std::span<const float> values, int layer, int level, int channels) {
    if (channels == 0) channels = channel_count(desc_.format);
    assert(level >= 0 && level < desc_.mips && layer >= 0 && layer < desc_.layers);
    if (!is_integer(desc_.format)) return upload_texels(place(level, layer), values, channels);
    const TextureFormat format = desc_.format;
    upload_texels(place(level, layer),
                  converted<std::uint32_t>(values, [format](float v) { return to_bits(v, format); }),
                  channels);
}

void Texture::upload(std::span<const std::uint32_t> values, int layer, int level) {
    assert(level >= 0 && level < desc_.mips && layer >= 0 && layer < desc_.layers);
    const int channels = channel_count(desc_.format);
    if (is_integer(desc_.format)) return upload_texels(place(level, layer), values, channels);
    upload_texels(place(level, layer),
                  converted<float>(values, [](std::uint32_t v) { return static_cast<float>(v); }), channels);
}

TexelRead Texture::begin_read(int channels, ReadAs as) const {
    return {place(0, 0), channels == 0 ? channel_count(desc_.format) : channels, as};
}

std::vector<float> Texture::read_floats(int level, int layer) const {
    if (!is_integer(desc_.format)) return read_values<float>(place(level, layer));
    const auto bits = read_values<std::uint32_t>(place(level, layer));
    const TextureFormat format = desc_.format;
    return converted<float>(std::span(bits), [format](std::uint32_t v) { return from_bits(v, format); });
}

std::vector<std::uint32_t> Texture::read_uints(int level, int layer) const {
    if (is_integer(desc_.format)) return read_values<std::uint32_t>(place(level, layer));
    const auto floats = read_values<float>(place(level, layer));
    return converted<std::uint32_t>(std::span(floats), to_integer<std::uint32_t>);
}

void Texture::clear(float value) {
    clear_to({value, value, value, value});
}

void Texture::clear_to(const std::array<double, 4>& value) {
    clear_to(value, std::nullopt, std::nullopt);
}

void Texture::clear_to(const std::array<double, 4>& value, std::optional<int> level,
                       std::optional<int> layer) {
    assert(level.value_or(0) < desc_.mips && layer.value_or(0) < desc_.layers);
    handle_.context().make_current();
    const Context::Impl& impl = handle_.context().impl();
    const GladGLContext& gl = impl.gl;
    const std::array<std::uint32_t, 4> texel = clear_texel(value, desc_.format);
    const auto [internal, pixel, type] = gl_format(desc_.format);
    const int first = level.value_or(0);
    const int last = level.value_or(desc_.mips - 1);
    // llvmpipe clears a texture on the caller's thread, and what is drawn to on all of its own.
    const bool draws = impl.info.software && desc_.layers == 1 && is_stored_alike(desc_, value);
    if (!draws) impl.wait_for_draws();
    for (int i = first; i <= last; ++i) {
        if (draws) {
            const Attachment target{.texture = cached(), .level = i};
            clear_drawn(gl, impl.cache->framebuffer({&target, 1}), desc_, texel);
            continue;
        }
        if (!layer) {
            gl.ClearTexImage(handle(), i, pixel, type, texel.data());
        } else {
            gl.ClearTexSubImage(handle(), i, 0, 0, *layer, level_side(desc_.width, i),
                                level_side(desc_.height, i), 1, pixel, type, texel.data());
        }
    }
    handle_.context().check(fmt::format("clearing texture '{}'", label_));
}

void Texture::generate_mips() {
    assert(!is_integer(desc_.format));
    handle_.context().make_current();
    handle_.context().gl().GenerateTextureMipmap(handle());
    handle_.context().check(fmt::format("mip levels of texture '{}'", label_));
}

}  // namespace aftershade::gpu
