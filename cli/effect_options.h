// --effect-path, --allow-path and --ocio, shared by every verb that looks for effects.
#pragma once

#include <string>
#include <vector>

#include "cli/cli11.h"
#include "framework/base/diagnostics.h"
#include "framework/effect/registry.h"

namespace aftershade::cli {

/// With --allow-path.
void add_effect_path_option(CLI::App& app, std::vector<std::string>& paths);

/// --ocio, for verbs that bind looks: sets $OCIO, for the processes that this one starts too.
void add_ocio_option(CLI::App& app);

/// A path that is not a folder is a fault.
void check_effect_paths(const std::vector<std::string>& paths, Diagnostics& diagnostics);
/// --allow-path, for verbs whose documents name files (framework/base/path_bounds.h).
void add_allow_path_option(CLI::App& app);

/// The shipped effects, below those of `paths`; a path that is not a folder is a fault.
EffectRegistry find_effects(const std::vector<std::string>& paths, Diagnostics& diagnostics);

}  // namespace aftershade::cli
