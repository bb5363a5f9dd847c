// Forms of values that documents about images share.
#pragma once

#include "framework/document/grammar.h"

namespace aftershade {

/// The form of names of roles besides the fixed ones: "aov:mist".
grammar::Pattern aov_pattern();

/// The name of a role.
grammar::Form role_form();

/// The same and the roles that steps alone have.
grammar::Form step_role_form();

/// "auto" and the names of colour spaces.
grammar::Form color_space_form();

}  // namespace aftershade
