// JSON Schema (draft 2020-12) of declared documents.
#pragma once

#include <string>

#include "framework/document/grammar.h"

namespace aftershade::grammar {

/// The JSON Schema of a document, as a file's text.
std::string schema_text(const std::string& title, const Block& document);

}  // namespace aftershade::grammar
