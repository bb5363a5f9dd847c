// `aftershade check LOOK --warmup CAPTURE`.
#pragma once

#include <string>
#include <vector>

#include "cli/plugin_options.h"
#include "framework/base/error.h"
#include "framework/batch/process_codes.h"
#include "framework/gpu/context.h"

namespace aftershade::cli {

struct WarmupCheck {
    std::string look;
    std::string capture;
    std::vector<std::string> effect_paths;
    PluginOptions plugins;
    gpu::GlChoice gl;
};

/// Prints what a chunk's first frame differs by after more and more warm-up, and what the look declares. Exit
/// 1 where the declared warm-up leaves more than its error.
ExitCode check_warmup(const WarmupCheck& check);

}  // namespace aftershade::cli
