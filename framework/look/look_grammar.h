// The grammar of a look, declared once (framework/document/grammar.h). The manifest of each
// effect declares its parameters, inputs and presets.
#pragma once

#include <cstddef>

#include "framework/document/grammar.h"

namespace aftershade {

/// Most ids, ranges of ids and names of one mask: what a uniform block of 16 KiB, GL's least, holds.
inline constexpr std::size_t kMaxMaskObjects = 1000;

/// The document. Its steps are checked one by one, when variables are put in.
const grammar::Block& look_block();
/// A step with an effect.
const grammar::Block& look_step_block();
/// A step that uses another look.
const grammar::Block& look_use_block();
const grammar::Block& look_mask_block();
/// Where an input comes from.
grammar::Form look_wire();

}  // namespace aftershade
