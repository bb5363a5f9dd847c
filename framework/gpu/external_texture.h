// Textures and fences of another context of the share group, by GL's names.
#pragma once

#include <cstdint>
#include <string>

#include "framework/gpu/context.h"
#include "framework/gpu/texture.h"

namespace aftershade::gpu {

/// A two-dimensional texture; its level 0.
struct ExternalTexture {
    std::uint32_t name = 0;
    int width = 0;
    int height = 0;
    bool bottom_up = false;  ///< texel row 0 is the image's bottom row
};

/// Throws Error(ErrorKind::usage), beginning with `label`, where there is no such texture of this size, or
/// where its format cannot hold `channels` floats (or unsigned integers), of which three need four. [the
/// context's thread, as all below]
void check_external_texture(Context& context, const ExternalTexture& texture, int channels, bool is_integer,
                            const std::string& label);

/// Copies on the GPU, formats converted. Sizes are equal (asserted), and the external texture was checked.
void copy_texture(Context& context, const ExternalTexture& from, const Texture& to);
void copy_texture(Context& context, const Texture& from, const ExternalTexture& to);

/// Lets the commands that follow wait, on the GPU, for a fence (GLsync) of another context. Throws
/// Error(ErrorKind::usage) where it is none.
void wait_for_fence(Context& context, void* fence);
/// A fence behind all commands so far, flushed; the caller deletes it.
void* insert_fence(Context& context);

}  // namespace aftershade::gpu
