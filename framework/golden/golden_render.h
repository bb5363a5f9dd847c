// The images of a case, made by a worker process: `aftershade run` of this very executable.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "framework/golden/golden_case.h"

namespace aftershade {

struct GoldenRenderOptions {
    std::string backend = "software";       ///< as `--backend` takes it
    std::function<std::string()> device{};  ///< of the next case, as `--device` takes it; "" for any
    std::vector<std::string> effect_paths;  ///< folders, the first wins
    std::vector<std::string> plugin_paths;
    std::chrono::milliseconds timeout{600'000};  ///< of one case, wall time
    int threads = 1;                             ///< llvmpipe's, where LP_NUM_THREADS says nothing
};

struct RenderedImage {
    std::string name;    ///< "lamps.color.0001"
    std::string output;  ///< role, or "step.texture" of a tap
    int frame = 0;
    std::filesystem::path file;
};

struct RenderedCase {
    /// same: rendered. warning: rendered, after a first run that crashed. failure: an effect or a document is
    /// wrong, or the time is over. file_error: the capture cannot be read, there is no GL, or nothing can be
    /// written.
    Verdict verdict = Verdict::same;
    std::string absent;  ///< what is not there, so that an optional case is skipped; "" otherwise
    /// What the worker said: that it crashed first, its warnings, and everything if it failed.
    std::vector<std::string> messages;
    std::vector<RenderedImage> images;  ///< every output and tap of every frame; none after a failure
    std::string command;                ///< for a shell
    double seconds = 0;                 ///< wall time of the worker
    bool interrupted = false;
};

/// Renders into `work`, an empty folder of the case's own. Images hold only channels, windows and
/// chromaticities: the same picture gives the same bytes wherever it is made. Throws
/// Error(ErrorKind::output). [thread-safe for different folders]
RenderedCase render_case(const GoldenCase& test, const GoldenRenderOptions& options,
                         const std::filesystem::path& work, const std::atomic<bool>& interrupt);

}  // namespace aftershade
