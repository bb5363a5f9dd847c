// Whether a fresh context renders at all. Internal to framework/gpu.
#pragma once

#include "framework/gpu/context.h"

namespace aftershade::gpu {

/// Draws a colour outside [0, 1] into a float framebuffer and reads it back. Throws Error with what came
/// instead.
void self_test(Context& context);

}  // namespace aftershade::gpu
