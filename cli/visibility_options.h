// The options of `render` for pictures by many visibility samples, and what it says of them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/cli11.h"
#include "cli/gl_options.h"
#include "framework/base/diagnostics.h"
#include "framework/scene/visibility.h"

namespace aftershade::cli {

struct VisibilityArguments {
    std::string visibility = "none";
    std::string cache = "global";
    std::string grid = "triangle";
    std::string transparency = "stochastic";
    std::string device = "cpu";
    GlOptions gl{};
    scene::VisibilitySettings settings;
    bool has_list_nodes = false;
    std::vector<std::string> given{};  ///< options that are of no use without --visibility memoised
};

void add_visibility_options(CLI::App& app, VisibilityArguments& options);

/// nullopt for "none".
std::optional<scene::VisibilitySettings> read_visibility(const VisibilityArguments& options,
                                                         Diagnostics& diagnostics);

nlohmann::ordered_json visibility_json(const std::vector<scene::VisibilityReport>& reports);
void print_visibility(const std::vector<scene::VisibilityReport>& reports);

}  // namespace aftershade::cli
