// Whether a golden case gives the same bits each time that it is drawn, and where it first does not.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "framework/batch/golden_render.h"

namespace aftershade {

/// Draws the case `runs` - 1 more times, in folders below `work`. "" where each has the bits of `first`; else
/// a sentence with the image that differs, and the first texture of a pass that does. Throws
/// Error(ErrorKind::output).
std::string difference_of_runs(const GoldenCase& test, const GoldenRenderOptions& options,
                               const RenderedCase& first, int runs, const std::filesystem::path& work,
                               const std::atomic<bool>& interrupt);

}  // namespace aftershade
