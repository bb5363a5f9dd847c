// Texels of one level and layer of a texture, from and to the caller's memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "framework/gpu/context.h"
#include "framework/gpu/texture_desc.h"

namespace aftershade::gpu {

/// Where the texels are. [refers to what the caller keeps]
struct TexelPlace {
    Context& context;
    unsigned int texture = 0;
    const TextureDesc& desc;
    const std::string& label;
    int level = 0;
    int layer = 0;

    int width() const;
    int height() const;
    std::size_t texel_count() const;
};

/// Of each pixel `channels` values, at most as many as the texture has; the others are zero. Floats go into
/// floats, integers into integers.
void upload_texels(const TexelPlace& place, std::span<const float> values, int channels);
void upload_texels(const TexelPlace& place, std::span<const std::uint32_t> values, int channels);

/// Texels on their way to the caller. Where transfers are direct, they are fetched when finish() is called,
/// and the texture must be as it was until then. Where they are mapped, later commands may change it.
/// [the context's thread, within the context's life]
class TexelRead {
public:
    /// `channels` of each pixel, the first ones.
    TexelRead(const TexelPlace& place, int channels);
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
