// What effect.json and module.json may say, declared once (core/grammar.h): from here come the parser's
// checks, the JSON Schemas and the tables of docs/shaders.md. What depends on two parts of a manifest, the
// parser checks.
#pragma once

#include <string>

#include "framework/document/grammar.h"

namespace aftershade {

/// An effect.json.
const grammar::Block& effect_block();
/// A module.json.
const grammar::Block& module_block();
/// A group of entries, for its table: of `textures`, and alike in other sections.
const grammar::Block& group_block();

/// JSON Schema of an effect.json.
std::string effect_schema();
/// JSON Schema of a module.json.
std::string module_schema();

}  // namespace aftershade
