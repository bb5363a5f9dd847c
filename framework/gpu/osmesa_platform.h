// OSMesa, opened at run time. Internal to framework/gpu.
#pragma once

#include <memory>

#include "framework/gpu/platform.h"

namespace aftershade::gpu {

/// Throws Error(ErrorKind::gl) whose message is the reason alone.
std::unique_ptr<Platform> make_osmesa_platform();
/// Throws Error(ErrorKind::gl).
void load_osmesa();

}  // namespace aftershade::gpu
