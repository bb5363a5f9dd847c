// The main work: frames in, pipeline over each, files out.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/pipeline/output_options.h"
#include "framework/pipeline/pipeline.h"
#include "framework/pipeline/renderer.h"
#include "framework/pipeline/run_options.h"

namespace aftershade {

/// Milliseconds of one pass over all frames.
struct PassStatistics {
    std::string pass;
    double total_ms = 0;
    double min_ms = 0;
    double max_ms = 0;
    int frames = 0;
};

struct RunReport {
    int frames_done = 0;
    std::vector<std::string> failures;   ///< one message per frame that could not be read
    int frames_skipped = 0;              ///< missing, and MissingFrame::skip
    int frames_unwritten = 0;            ///< rendered for what they leave to later frames
    std::vector<PassStatistics> passes;  ///< in the order of the passes
    double read_ms = 0;                  ///< waiting for frames to be read and decoded
    double write_ms = 0;                 ///< waiting for files to be written
    double wall_ms = 0;
    bool interrupted = false;
    std::vector<FrameTelemetry> telemetry;  ///< of every frame, where it was asked for
    std::string graph_dot;                  ///< of the last frame, in Graphviz's language
    std::uint64_t bytes = 0;                ///< of its textures and buffers
    std::uint64_t bytes_unaliased = 0;      ///< what these would take if none shared memory
    ExitCode exit_code() const;
};

/// Called on the caller's thread. Any may be empty.
struct RunObserver {
    std::function<void(const Capture&)> frame_started;
    std::function<void(const std::filesystem::path&)> file_written;
    std::function<void(const std::string&)> frame_failed;
    std::function<void(const CaptureHeader&, const std::vector<AuditFinding>&)> frame_audited;
    std::function<void(int frame, const std::string& what)> frame_missing;  ///< skipped or held
    /// Frames but the first that begin history anew, where some step has history.
    std::function<void(int frame, const std::string& reason)> history_reset;
    std::function<void(int frame, const std::string& line)> native_message;
};

/// What a run that can go on later does beside each frame. Any may be empty. On the caller's thread unless
/// said otherwise; what they throw ends the run.
struct RunHooks {
    std::function<void(int frame, PipelineRenderer& renderer)> before_frame;
    /// Whether the frame is written; one that is not is rendered for what it leaves to later frames.
    std::function<bool(int frame)> is_written;
    /// After before_frame, of a frame that is written: its OutputOptions::fingerprint.
    std::function<std::string(int frame)> fingerprint;
    std::function<void(int frame, PipelineRenderer& renderer)> after_frame;
    std::function<void(int frame, PipelineRenderer& renderer)> frame_failed;  ///< it could not be read
    /// Once the files are in place; `seconds` since the frame was begun. [on another thread; one call at a
    /// time]
    std::function<void(int frame, const std::vector<std::filesystem::path>& files, double seconds)>
        frame_written;
    /// What the history that RunOptions::history_out names shall say it is of.
    std::function<std::string()> last_fingerprint;
};

/// What a run works with. [refers to what the caller keeps]
struct RunSetup {
    gpu::Context& context;
    const Pipeline& pipeline;
    const Sequence& sequence;
    const CaptureReader& reader;
    const RunOptions& options;
    const OutputOptions& outputs;
    std::filesystem::path data_folder;
    RunHooks hooks{};
};

/// Reads the next frame and writes the last one while the GPU works. A frame that cannot be read is reported
/// and left out; an effect or an output that fails ends the run by its Error. `stop` is looked at between
/// frames.
RunReport run_frames(const RunSetup& setup, const RunObserver& observer, const std::atomic<bool>& stop);

}  // namespace aftershade
