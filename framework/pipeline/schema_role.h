// The piece of the schemas that names roles.
#pragma once

#include "framework/core/schema_pieces.h"

namespace aftershade::schema {

inline constexpr const char* kAovPattern = "^aov:.+$";
/// Name of a role: a fixed one, or "aov:<name>".
json role();

}  // namespace aftershade::schema
