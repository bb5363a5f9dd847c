// The grammar of golden suites and of effects' cases, declared once (framework/document/grammar.h).
#pragma once

#include <string>

#include "framework/document/grammar.h"

namespace aftershade {

/// What can begin the names of a case's images, and stand in a glob, a comment and a command as itself.
bool is_case_name(const std::string& name);

/// golden.json
const grammar::Block& golden_suite_block();
/// effects/<id>/cases/<case>.json
const grammar::Block& effect_case_block();
const grammar::Block& golden_tolerance_block();

}  // namespace aftershade
