// The grammar of a producer's profile, declared once (framework/core/grammar.h).
#pragma once

#include <string>

#include "framework/core/grammar.h"

namespace aftershade {

/// profiles/<id>.json
const grammar::Block& profile_block();

/// JSON Schema of a profile.
std::string profile_schema();

}  // namespace aftershade
