// --effect-path, shared by every verb that looks for effects.
#pragma once

#include <string>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/effect/registry.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

void add_effect_path_option(CLI::App& app, std::vector<std::string>& paths);

/// A path that is no folder is a fault.
void check_effect_paths(const std::vector<std::string>& paths, Diagnostics& diagnostics);

/// The shipped effects, below those of `paths`; a path that is no folder is a fault.
EffectRegistry find_effects(const std::vector<std::string>& paths, Diagnostics& diagnostics);

}  // namespace aftershade::cli
