// The grammar of golden suites and of effects' cases, declared once (framework/document/grammar.h).
#pragma once

#include "framework/document/grammar.h"

namespace aftershade {

/// golden.json
const grammar::Block& golden_suite_block();
/// effects/<id>/cases/<case>.json
const grammar::Block& effect_case_block();
const grammar::Block& golden_tolerance_block();

}  // namespace aftershade
