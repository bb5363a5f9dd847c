#include "framework/gpu/texel_read.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "framework/base/half_values.h"
#include "framework/gpu/context_internal.h"
#include "framework/gpu/half_kernels.h"

namespace aftershade::gpu {
namespace {

/// GL counts the bytes of one call in a signed 32-bit integer.
constexpr std::size_t kMaxReadBytes = std::size_t{1} << 30;
/// Less than a core's second cache has.
constexpr std::size_t kCachedReadBytes = std::size_t{1} << 19;

/// HalfKernels::pack().
constexpr std::size_t kFlagBytes = 16;

void get_image(const TexelPlace& place, int row, int rows, std::size_t bytes, void* values) {
    const auto [internal, pixel, type] = gl_format(place.desc.format);
    place.context.gl().GetTextureSubImage(place.texture, place.level, 0, row, place.layer, place.width(),
                                          rows, 1, pixel, type, static_cast<GLsizei>(bytes), values);
}

}  // namespace

struct TexelRead::State {
    // A copy: the texture's own object may move.
    Context& context;
    unsigned int texture;
    TextureDesc desc;
    std::string label;
    int level, layer;
    std::size_t channels;
    bool as_halfs = false;
    std::vector<MappedPiece> pieces{};
    std::vector<MappedPiece> flags{};    ///< of pieces of halfs: not 0 where a piece has floats
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
    void expand(const void* halfs, std::size_t begin, std::size_t end, Value* to,
                const std::function<void(std::span<const Value>)>& reader) const;
    template <typename Value>
    void narrow(const Value* from, std::size_t pixels, Value* to,
                const std::function<void(std::span<const Value>)>& reader) const;
};

/// Whether all is on its way.
bool TexelRead::State::issue() {
    drawn = Fence(context.gl());
    const TexelPlace at = place();
    const std::size_t row_bytes =
        static_cast<std::size_t>(at.width()) * at.stored_channels() * sizeof(std::uint32_t);
    for (int row = 0; row < at.height();) {
        const auto left = static_cast<std::size_t>(at.height() - row);
        auto piece = context.impl().transfers->to_read(row_bytes, row_bytes * left);
        if (!piece) {
            pieces.clear();
            flags.clear();
            return false;
        }
        const int rows = static_cast<int>(piece->memory.size() / row_bytes);
        auto flag = as_halfs ? context.impl().transfers->to_read(kFlagBytes, kFlagBytes) : std::nullopt;
        if (flag) {
            half_kernels(context).pack(at, {row, rows}, *piece, *flag);
            flags.push_back(std::move(*flag));
        } else {
            as_halfs = false;
            context.gl().BindBuffer(GL_PIXEL_PACK_BUFFER, piece->buffer->name);
            get_image(at, row, rows, piece->memory.size(), reinterpret_cast<void*>(piece->offset));
            context.gl().BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        }
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
    const std::size_t row_values = static_cast<std::size_t>(at.width()) * at.stored_channels();
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
    const std::size_t stored = place().stored_channels();
    const std::size_t step = std::max<std::size_t>(1, kCachedReadBytes / (stored * sizeof(Value)));
    for (std::size_t pixel = 0; pixel < pixels; pixel += step) {
        const std::size_t count = std::min(step, pixels - pixel);
        Value* const there = to + pixel * channels;
        copy_channels(from + pixel * stored, stored, there, channels, count);
        if (reader) reader(std::span<const Value>(there, count * channels));
    }
}

/// Pixels of a piece of halfs.
template <typename Value>
void TexelRead::State::expand(const void* halfs, std::size_t begin, std::size_t end, Value* to,
                              const std::function<void(std::span<const Value>)>& reader) const {
    if constexpr (std::is_same_v<Value, float>) {
        std::array<float, 4 * kHalfBlock> block;
        const auto* const from = static_cast<const std::uint16_t*>(halfs);
        for (std::size_t i = begin; i < end; i += kHalfBlock) {
            const std::size_t count = std::min(kHalfBlock, end - i);
            from_halfs(from + 4 * i, block.data(), 4 * count);
            narrow(block.data(), count, to + (i - begin) * channels, reader);
        }
    }
}

template <typename Value>
void TexelRead::State::finish(std::span<Value> values,
                              const std::function<void(std::span<const Value>)>& reader) {
    const TexelPlace at = place();
    const std::size_t stored = at.stored_channels();
    assert(values.size() == at.texel_count() * channels);
    if (!pieces.empty()) {
        context.make_current();
        drawn.wait();
        const Transfers::Timed timed(*context.impl().transfers, &TransferUse::read_ms);
        fence.wait();
        Value* to = values.data();
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const auto* const from = reinterpret_cast<const Value*>(pieces[i].memory.data());
            const std::size_t pixels = pieces[i].memory.size() / (stored * sizeof(Value));
            // The first flags are those of the first pieces.
            const bool has_halfs = i < flags.size() && flags[i].memory.front() == std::byte{0};
            context.impl().transfers->share_out(
                pixels, stored * sizeof(Value), [&](std::size_t begin, std::size_t end) {
                    if (has_halfs) return expand(from, begin, end, to + begin * channels, reader);
                    narrow(from + begin * stored, end - begin, to + begin * channels, reader);
                });
            to += pixels * channels;
        }
        pieces.clear();
        flags.clear();
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

TexelRead::TexelRead(const TexelPlace& place, int channels, ReadAs as)
    : state_(std::make_unique<State>(State{place.context, place.texture, place.desc, place.label, place.level,
                                           place.layer, static_cast<std::size_t>(channels)})) {
    assert(place.level >= 0 && place.level < place.desc.mips && place.layer >= 0 &&
           place.layer < place.desc.layers);
    place.context.make_current();
    if (!place.context.impl().transfers->is_mapped()) return;
    place.context.impl().wait_for_draws();
    state_->as_halfs = as == ReadAs::halfs && place.may_be_halfs();
    if (place.is_unconverted() && state_->issue()) return;
    state_->words.resize(place.texel_count() * place.stored_channels());
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
