// The platform of a backend. Internal to framework/gpu.
#pragma once

#include <memory>

#include "framework/gpu/platform.h"

namespace aftershade::gpu {

/// The platform of one backend. Throws Error(ErrorKind::gl) whose message is the reason alone, and
/// Error(ErrorKind::usage) where no device has the name of the choice.
std::unique_ptr<Platform> make_platform(const GlChoice& choice);

}  // namespace aftershade::gpu
