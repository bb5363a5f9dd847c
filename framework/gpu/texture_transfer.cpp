#include "framework/gpu/texture_transfer.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "framework/gpu/context_internal.h"
#include "framework/gpu/texture_format.h"

namespace aftershade::gpu {
namespace {

/// GL counts the bytes of one call in a signed 32-bit integer.
constexpr std::size_t kMaxReadBytes = std::size_t{1} << 30;
/// Less than a core's second cache has.
constexpr std::size_t kCachedReadBytes = std::size_t{1} << 19;

/// Whether texels are the values of client memory, so that no driver converts them, each in its way.
bool is_unconverted(TextureFormat format) {
    return bytes_per_texel(format) == 4 * channel_count(format);
}

std::size_t stored_channels(const TexelPlace& place) {
    return static_cast<std::size_t>(channel_count(place.desc.format));
}

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

void get_image(const TexelPlace& place, int row, int rows, std::size_t bytes, void* values) {
    const auto [internal, pixel, type] = gl_format(place.desc.format);
    place.context.gl().GetTextureSubImage(place.texture, place.level, 0, row, place.layer, place.width(),
                                          rows, 1, pixel, type, static_cast<GLsizei>(bytes), values);
}

void* offset_pointer(std::size_t offset) {
    return reinterpret_cast<void*>(offset);
}

/// The row before which all went.
template <typename Value>
int upload_mapped(const TexelPlace& place, std::span<const Value> values, std::size_t channels) {
    Context::Impl& impl = place.context.impl();
    const std::size_t stored = stored_channels(place);
    const auto width = static_cast<std::size_t>(place.width());
    const std::size_t row_bytes = width * stored * sizeof(Value);
    int row = 0;
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
        sub_image(place, row, static_cast<int>(rows), offset_pointer(piece->offset));
        impl.gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
        row += static_cast<int>(rows);
    }
    return row;
}

template <typename Value>
void upload(const TexelPlace& place, std::span<const Value> values, int channels) {
    const auto from = static_cast<std::size_t>(channels);
    const std::size_t stored = stored_channels(place);
    assert(values.size() == place.texel_count() * from && from <= stored);
    place.context.make_current();
    Context::Impl& impl = place.context.impl();
    impl.wait_for_draws();
    const Transfers::Timed timed(*impl.transfers, &TransferUse::upload_ms);
    int row = 0;
    if (impl.transfers->is_mapped() && is_unconverted(place.desc.format))
        row = upload_mapped(place, values, from);
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

int TexelPlace::width() const {
    return std::max(1, desc.width >> level);
}

int TexelPlace::height() const {
    return std::max(1, desc.height >> level);
}

std::size_t TexelPlace::texel_count() const {
    return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
}

void upload_texels(const TexelPlace& place, std::span<const float> values, int channels) {
    assert(!is_integer(place.desc.format));
    upload(place, values, channels);
}

void upload_texels(const TexelPlace& place, std::span<const std::uint32_t> values, int channels) {
    assert(is_integer(place.desc.format));
    upload(place, values, channels);
}

struct TexelRead::State {
    // A copy: the texture's own object may move.
    Context& context;
    unsigned int texture;
    TextureDesc desc;
    std::string label;
    int level, layer;
    std::size_t channels;
    std::vector<MappedPiece> pieces{};
    std::vector<std::uint32_t> words{};  ///< read at once, for want of pieces
    Fence drawn{}, fence{};              ///< behind what the texels come from, and behind their way

    TexelPlace place() const { return {context, texture, desc, label, level, layer}; }
    bool issue();
    template <typename Value>
    void read_now(Value* values, std::size_t band_bytes,
                  const std::function<void(std::span<const Value>)>& read);
    template <typename Value>
    void finish(std::span<Value> values, const std::function<void(std::span<const Value>)>& reader);
    template <typename Value>
    void narrow(const Value* from, std::size_t pixels, Value* to,
                const std::function<void(std::span<const Value>)>& reader) const;
};

/// Whether all is on its way.
bool TexelRead::State::issue() {
    drawn = Fence(context.gl());
    const TexelPlace at = place();
    const std::size_t row_bytes =
        static_cast<std::size_t>(at.width()) * stored_channels(at) * sizeof(std::uint32_t);
    for (int row = 0; row < at.height();) {
        const auto left = static_cast<std::size_t>(at.height() - row);
        auto piece = context.impl().transfers->to_read(row_bytes, row_bytes * left);
        if (!piece) {
            pieces.clear();
            return false;
        }
        const int rows = static_cast<int>(piece->memory.size() / row_bytes);
        context.gl().BindBuffer(GL_PIXEL_PACK_BUFFER, piece->buffer->name);
        get_image(at, row, rows, piece->memory.size(), offset_pointer(piece->offset));
        context.gl().BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        pieces.push_back(std::move(*piece));
        row += rows;
    }
    fence = Fence(context.gl());
    context.gl().Flush();
    return true;
}

/// All stored channels; `read` gets each band of at most `band_bytes`.
template <typename Value>
void TexelRead::State::read_now(Value* values, std::size_t band_bytes,
                                const std::function<void(std::span<const Value>)>& read) {
    const TexelPlace at = place();
    context.make_current();
    context.impl().wait_for_draws();
    if (!context.info().software) Fence(context.gl()).wait();
    const Transfers::Timed timed(*context.impl().transfers, &TransferUse::read_ms);
    const std::size_t row_values = static_cast<std::size_t>(at.width()) * stored_channels(at);
    const int band =
        std::max(1, static_cast<int>(std::min(band_bytes, kMaxReadBytes) / (row_values * sizeof(Value))));
    for (int row = 0; row < at.height(); row += band) {
        const int rows = std::min(band, at.height() - row);
        Value* const to = values + row_values * static_cast<std::size_t>(row);
        const std::size_t count = row_values * static_cast<std::size_t>(rows);
        get_image(at, row, rows, count * sizeof(Value), to);
        if (read) read(std::span<const Value>(to, count));
    }
}

template <typename Value>
void TexelRead::State::narrow(const Value* from, std::size_t pixels, Value* to,
                              const std::function<void(std::span<const Value>)>& reader) const {
    const std::size_t stored = stored_channels(place());
    const std::size_t step = std::max<std::size_t>(1, kCachedReadBytes / (stored * sizeof(Value)));
    for (std::size_t pixel = 0; pixel < pixels; pixel += step) {
        const std::size_t count = std::min(step, pixels - pixel);
        Value* const there = to + pixel * channels;
        copy_channels(from + pixel * stored, stored, there, channels, count);
        if (reader) reader(std::span<const Value>(there, count * channels));
    }
}

template <typename Value>
void TexelRead::State::finish(std::span<Value> values,
                              const std::function<void(std::span<const Value>)>& reader) {
    const TexelPlace at = place();
    const std::size_t stored = stored_channels(at);
    assert(values.size() == at.texel_count() * channels);
    if (!pieces.empty()) {
        context.make_current();
        drawn.wait();
        const Transfers::Timed timed(*context.impl().transfers, &TransferUse::read_ms);
        fence.wait();
        Value* to = values.data();
        for (const MappedPiece& piece : pieces) {
            const auto* const from = reinterpret_cast<const Value*>(piece.memory.data());
            const std::size_t pixels = piece.memory.size() / (stored * sizeof(Value));
            context.impl().transfers->share_out(
                pixels, stored * sizeof(Value), [&](std::size_t begin, std::size_t end) {
                    narrow(from + begin * stored, end - begin, to + begin * channels, reader);
                });
            to += pixels * channels;
        }
        pieces.clear();
    } else if (!words.empty()) {
        narrow(reinterpret_cast<const Value*>(words.data()), at.texel_count(), values.data(), reader);
    } else if (channels == stored) {
        read_now<Value>(values.data(), reader ? kCachedReadBytes : kMaxReadBytes, reader);
    } else {
        std::vector<Value> all(at.texel_count() * stored);
        read_now<Value>(all.data(), kMaxReadBytes, {});
        narrow(all.data(), at.texel_count(), values.data(), reader);
    }
    context.check(fmt::format("reading texture '{}'", label));
}

TexelRead::TexelRead(const TexelPlace& place, int channels)
    : state_(std::make_unique<State>(State{place.context, place.texture, place.desc, place.label, place.level,
                                           place.layer, static_cast<std::size_t>(channels)})) {
    assert(place.level >= 0 && place.level < place.desc.mips && place.layer >= 0 &&
           place.layer < place.desc.layers);
    place.context.make_current();
    if (!place.context.impl().transfers->is_mapped()) return;
    place.context.impl().wait_for_draws();
    if (is_unconverted(place.desc.format) && state_->issue()) return;
    state_->words.resize(place.texel_count() * stored_channels(place));
    state_->read_now<std::uint32_t>(state_->words.data(), kMaxReadBytes, {});
}

TexelRead::TexelRead(TexelRead&&) noexcept = default;

TexelRead::~TexelRead() {
    if (state_ && !state_->context.impl().try_make_current()) {
        state_->drawn.leak();
        state_->fence.leak();
    }
}

void TexelRead::finish(std::span<float> values, const Reader& reader) {
    assert(!is_integer(state_->desc.format));
    state_->finish<float>(values, reader);
}

void TexelRead::finish(std::span<std::uint32_t> values) {
    assert(is_integer(state_->desc.format));
    state_->finish<std::uint32_t>(values, {});
}

}  // namespace aftershade::gpu
