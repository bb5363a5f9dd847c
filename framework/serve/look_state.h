// A look's text bound to its effects; its steps and faults, as the page reads them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/base/diagnostics.h"
#include "framework/capture/capture.h"
#include "framework/effect/registry.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"

namespace aftershade::serve {

/// A text without faults, bound to its effects.
struct BoundText {
    std::string text;
    std::shared_ptr<EffectRegistry> effects;  ///< owns the manifests of `pipeline`
    Look look;
    Pipeline pipeline;
    std::vector<std::string> files{};  ///< that it names, with links followed
    std::uint64_t revision = 0;
    std::uint64_t effects_revision = 0;
};

/// Faults go to `faults`; nullptr where the text is not a look. Its revisions are 0.
std::shared_ptr<BoundText> bind_text(const std::string& text, const std::filesystem::path& path,
                                     const std::shared_ptr<EffectRegistry>& effects, Diagnostics& faults);

/// {"line", "column", "where", "severity", "message"} for each.
nlohmann::ordered_json faults_json(const Diagnostics& faults);

/// One entry for each of the text's own steps; `bound` nullptr: without what only a whole look gives. A text
/// that is not JSON has none.
nlohmann::ordered_json steps_json(const std::string& text, const BoundText* bound, EffectRegistry& effects,
                                  const CaptureHeader& header);

}  // namespace aftershade::serve
