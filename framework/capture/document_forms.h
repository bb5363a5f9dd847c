// Forms of values that documents about images share.
#pragma once

#include <string>

#include "framework/core/grammar.h"

namespace aftershade {

/// What roles beside the fixed ones are named like: "aov:mist".
inline constexpr const char* kAovPattern = "^aov:.+$";

/// The name of a role.
grammar::Form role_form();
/// "1-100x2,120": at least one frame. `fault` is said of a text that is no range; "{}" is the text.
grammar::Form frame_range_form(const std::string& fault);
/// "auto" and the names of colour spaces.
grammar::Form color_space_form();

}  // namespace aftershade
