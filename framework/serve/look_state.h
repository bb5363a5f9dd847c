// A look's steps and faults, as the page reads them.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "framework/base/diagnostics.h"
#include "framework/capture/capture.h"
#include "framework/effect/registry.h"

namespace aftershade::serve {

struct BoundText;

/// {"line", "column", "where", "severity", "message"} for each.
nlohmann::ordered_json faults_json(const Diagnostics& faults);

/// One entry for each of the text's own steps; `bound` nullptr: without what only a whole look gives. A text
/// that is not JSON has none.
nlohmann::ordered_json steps_json(const std::string& text, const BoundText* bound, EffectRegistry& effects,
                                  const CaptureHeader& header);

}  // namespace aftershade::serve
