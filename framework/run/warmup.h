// Frames that a chunk of a sequence renders before its first one, so that history is nearly what it would be
// in an uncut run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/run/run_frames.h"

namespace aftershade {

/// The warm-up that the effects of a look declare ("warmup" in their manifests).
struct LookWarmup {
    int frames = 0;                       ///< the sum over its effects: each warms up on the one before it
    double error = 0;                     ///< the sum, as WarmupSpec has it
    std::vector<std::string> undeclared;  ///< steps that have history and declare no warm-up
};
LookWarmup warmup_of(const Pipeline& pipeline);

struct WarmupError {
    int frames = 0;  ///< rendered before the frame that is compared
    double error =
        0;  ///< 99th percentile of the difference of RGB from the uncut run, over the picture's mean
};

/// Renders the last frame of `setup.options.frames` after all frames before it, then after 0, 1, 2, 4, 8, ...
/// of them. Files go to `folder`; `observer` sees the first of these runs. Throws Error.
std::vector<WarmupError> measure_warmup(const RunSetup& setup, const std::filesystem::path& folder,
                                        const RunObserver& observer = {});

}  // namespace aftershade
