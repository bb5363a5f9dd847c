// Scattering profiles in the grammars of documents (framework/core/grammar.h).
#pragma once

#include "framework/core/grammar.h"

namespace aftershade::grammar {

/// A scattering profile: name, path or object. Whoever reads it checks it: files lie beside the document.
Form scattering_profile();

}  // namespace aftershade::grammar
