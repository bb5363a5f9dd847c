// EGL without a window, opened at run time. Internal to framework/gpu.
#pragma once

#include <memory>

#include "framework/gpu/platform.h"

namespace aftershade::gpu {

enum class Renderer { hardware, software };

/// Tries every EGL device of the kind asked for; a renderer of the other kind is refused.
/// Throws Error(ExitCode::gl) whose message is the reason alone.
std::unique_ptr<Platform> make_egl_platform(Renderer kind);

}  // namespace aftershade::gpu
