// Texels of a texture on their way to the caller's memory.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "framework/gpu/texel_place.h"

namespace aftershade::gpu {

/// `halfs`: the caller rounds them to halfs, so they may come rounded (to the nearest, ties to even). Values
/// beyond 65504, infinities and NaN come as they are.
enum class ReadAs { stored, halfs };

/// Texels on their way to the caller. Where transfers are direct, they are fetched when finish() is called,
/// and the texture must be as it was until then. Where they are mapped, later commands may change it.
/// [the context's thread, within the context's life]
class TexelRead {
public:
    /// `channels` of each pixel, the first ones.
    TexelRead(const TexelPlace& place, int channels, ReadAs as = ReadAs::stored);
    TexelRead(TexelRead&&) noexcept;
    ~TexelRead();

    /// Looks at values that were just read and are still in the processor's cache.
    using Reader = std::function<void(std::span<const float>)>;
    /// Once, into memory of width * height * channels values. `reader` gets all of them, some at a time, in
    /// no order. [calls it on several threads]
    void finish(std::span<float> values, const Reader& reader = {});
    void finish(std::span<std::uint32_t> values);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace aftershade::gpu
