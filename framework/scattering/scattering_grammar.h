// The grammar of scattering profiles, declared once (framework/document/grammar.h).
#pragma once

#include <string>

#include "framework/document/grammar.h"

namespace aftershade {

/// A profile in a file of its own.
const grammar::Block& scattering_profile_block();
/// A profile as an object within another document.
const grammar::Block& scattering_object_block();

/// JSON Schema of a scattering profile's own file.
std::string scattering_profile_schema();

}  // namespace aftershade

namespace aftershade::grammar {

/// A scattering profile: name, path or object. Its reader checks it, because files lie beside the document.
Form scattering_profile();

}  // namespace aftershade::grammar
