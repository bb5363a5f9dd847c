// The main work: frames in, pipeline over each, files out.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/look/pipeline.h"
#include "framework/render/renderer.h"
#include "framework/run/run_options.h"
#include "framework/run/run_report.h"

namespace aftershade {

/// Callbacks of a run that can resume later, for each frame. Any may be empty. They run on the caller's
/// thread unless noted; an exception ends the run.
struct RunHooks {
    std::function<void(int frame, PipelineRenderer& renderer)> before_frame;
    /// Whether the frame is written; one that is not is rendered for what it leaves to later frames.
    std::function<bool(int frame)> is_written;
    /// After before_frame, of a frame that is written: its OutputOptions::fingerprint.
    std::function<std::string(int frame)> fingerprint;
    /// Its passes were issued; its results may still be on their way.
    std::function<void(int frame, PipelineRenderer& renderer)> after_frame;
    std::function<void(int frame, PipelineRenderer& renderer)> frame_failed;  ///< it could not be read
    /// Once the files are in place; `seconds` since the frame was begun. [on another thread; one call at a
    /// time]
    std::function<void(int frame, const std::vector<std::filesystem::path>& files, double seconds)>
        frame_written;
    /// The label of the history of RunOptions::history_out.
    std::function<std::string()> last_fingerprint;
};

/// The inputs of a run. [refers to what the caller keeps]
struct RunSetup {
    /// The same each time. First called when a frame is being read already, so it may make the context then.
    std::function<gpu::Context&()> context;
    const Pipeline& pipeline;
    const Sequence& sequence;
    const CaptureReader& reader;
    const RunOptions& options;
    const OutputOptions& outputs;
    std::filesystem::path data_folder;
    RunHooks hooks{};
    /// Where nothing is drawn after the run: ends what context() made, after the last frame and while its
    /// files are written. Not called where a history is saved, or where a frame ends the run by an error.
    std::function<void()> end_context{};
};

/// Reads the next frame and writes the last one while the GPU works. Where transfers are mapped
/// (gpu::ContextInfo), a frame begins before the results of the one before are collected. A frame that cannot
/// be read, or that NanPolicy::fail refuses, is reported and left out; an effect or an output that fails, or
/// memory that runs out, ends the run by its Error. `stop` is looked at between frames.
RunReport run_frames(const RunSetup& setup, const RunObserver& observer, const std::atomic<bool>& stop);

}  // namespace aftershade
