// The three things a pass can do: draw over the whole target, dispatch, clear.
#pragma once

#include <span>
#include <string_view>

#include "framework/gpu/buffer.h"
#include "framework/gpu/program.h"
#include "framework/gpu/texture.h"

namespace aftershade::gpu {

enum class Filter { nearest, linear };
/// What a fetch outside the texture gives: the nearest texel, or zero.
enum class Wrap { clamp, zero };
enum class Access { read, write, read_write };
enum class Blend { none, add, min, max };
/// Of an instance: four vertices of a triangle strip, or one point.
enum class Primitive { quads, points };

struct SampledTexture {
    const Texture* texture = nullptr;
    int binding = 0;  ///< layout(binding = N) of the sampler
    Filter filter = Filter::nearest;
    Wrap wrap = Wrap::clamp;
};

struct ImageBinding {
    const Texture* texture = nullptr;
    int binding = 0;  ///< layout(binding = N) of the image
    int level = 0;
    Access access = Access::read_write;
};

struct BufferBinding {
    const Buffer* buffer = nullptr;
    int binding = 0;
};

struct Bindings {
    std::span<const SampledTexture> textures{};
    std::span<const ImageBinding> images{};
    std::span<const BufferBinding> uniforms{};  ///< uniform blocks
    std::span<const BufferBinding> storage{};   ///< shader storage blocks
};

/// Draws one triangle over all targets, which share one size; gl_FragCoord (0.5, 0.5) is texel (0, 0), the
/// top left, and NDC has +y at the top and z in [0, 1]. The vertex shader of `program` makes the triangle
/// from gl_VertexID 0..2. Throws Error(ExitCode::effect) naming `program` if GL reports an error or the
/// targets do not form a complete framebuffer.
void draw(Context& context, const Program& program, std::span<const Texture* const> targets,
          const Bindings& bindings, Blend blend = Blend::none);

/// Dispatches groups_x * groups_y * groups_z work groups, then a barrier for everything that a later pass may
/// read.
void dispatch(Context& context, const Program& program, int groups_x, int groups_y, int groups_z,
              const Bindings& bindings);

}  // namespace aftershade::gpu
