// EGL without a window, opened at run time. Internal to framework/gpu.
#pragma once

#include <memory>
#include <string>

#include "framework/gpu/platform.h"

namespace aftershade::gpu {

enum class Renderer { hardware, software };

/// Tries every EGL device of the kind and the name asked for ("": any); a renderer of the other kind is
/// refused. Throws Error(ErrorKind::gl) whose message is the reason alone, and Error(ErrorKind::usage) where
/// no device has the name.
std::unique_ptr<Platform> make_egl_platform(Renderer kind, const std::string& device);
/// A context that shares objects with the caller's, of whichever renderer. Throws likewise.
std::unique_ptr<Platform> make_egl_platform(const SharedEglContext& shared);

}  // namespace aftershade::gpu
