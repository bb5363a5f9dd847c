// WIDTH and HEIGHT of a pass of an ISF file.
#pragma once

#include <map>
#include <string>

#include "framework/effect/isf/isf_types.h"

namespace aftershade {

/// Faults of the formula, with their place in the file.
void check_isf_side(const IsfFile& file, const IsfPass& pass, int axis, Diagnostics& diagnostics);

/// "floor($WIDTH/2.0)" as the size of a texture has it: "floor(width/2.0)". `names`: of parameters, by input.
std::string native_formula(const std::string& side, const std::map<std::string, std::string>& names);

/// Whether the side of a pass depends on the input.
bool is_in_a_formula(const IsfFile& file, const std::string& input);

}  // namespace aftershade
