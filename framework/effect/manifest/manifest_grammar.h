// The keys of effect.json and module.json, declared once (document/grammar.h). The parser's checks, the JSON
// Schemas and the tables of docs/shaders.md come from this grammar. The parser itself checks rules between
// two parts of a manifest.
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
