// The grammar of golden suites and of effects' cases, declared once (framework/document/grammar.h).
#pragma once

#include <string>

#include "framework/document/grammar.h"

namespace aftershade {

/// Whether it can begin the names of a case's images, and means itself in a glob, a comment and a command.
bool is_case_name(const std::string& name);

/// golden.json
const grammar::Block& golden_suite_block();
/// effects/<id>/cases/<case>.json
const grammar::Block& effect_case_block();
const grammar::Block& golden_tolerance_block();

}  // namespace aftershade
