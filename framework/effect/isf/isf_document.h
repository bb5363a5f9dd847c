// The JSON of an ISF file. Internal to framework/effect/isf.
#pragma once

#include "framework/effect/isf/isf_types.h"

namespace aftershade {

/// Reads all but the texts of the shaders.
void read_isf_document(const Node& document, IsfFile& file, Diagnostics& diagnostics);

}  // namespace aftershade
