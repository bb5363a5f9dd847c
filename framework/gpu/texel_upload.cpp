#include "framework/gpu/texel_upload.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "framework/base/half_values.h"
#include "framework/gpu/context_internal.h"
#include "framework/gpu/half_kernels.h"

namespace aftershade::gpu {
namespace {

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

}  // namespace

void upload_texels(const TexelPlace& place, std::span<const float> values, int channels) {
    assert(!is_integer(place.desc.format));
    upload(place, values, channels);
}

void upload_texels(const TexelPlace& place, std::span<const std::uint32_t> values, int channels) {
    assert(is_integer(place.desc.format));
    upload(place, values, channels);
}

}  // namespace aftershade::gpu
