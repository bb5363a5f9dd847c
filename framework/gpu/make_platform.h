// The platform of a backend. Internal to framework/gpu.
#pragma once

#include <memory>

#include "framework/gpu/platform.h"

namespace aftershade::gpu {

/// Throws Error(ErrorKind::gl) whose message is the reason alone.
std::unique_ptr<Platform> make_platform(Backend backend);

}  // namespace aftershade::gpu
