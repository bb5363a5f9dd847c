// Every type that a parameter of an effect may have.
#pragma once

#include <span>

#include "framework/document/param.h"

namespace aftershade {

/// In the order of messages and schemas: those of core, then those that need more than core. [thread-safe]
std::span<const ParamType> param_types();

}  // namespace aftershade
