// What GL calls each TextureFormat. Internal to framework/gpu.
#pragma once

#include "framework/gpu/texture.h"

namespace aftershade::gpu {

struct GlFormat {
    unsigned int internal = 0;  ///< GL_RGBA32F, ...
    unsigned int pixel = 0;     ///< GL_RGBA, GL_RED_INTEGER, ...
};

GlFormat gl_format(TextureFormat format);

}  // namespace aftershade::gpu
