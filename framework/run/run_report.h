// Reports of a run, while it works and at its end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/base/status.h"
#include "framework/capture/capture.h"
#include "framework/gpu/context.h"
#include "framework/render/audit.h"
#include "framework/render/telemetry.h"

namespace aftershade {

/// Milliseconds of one pass over all frames.
struct PassStatistics {
    std::string pass;
    double total_ms = 0;
    double min_ms = 0;
    double max_ms = 0;
    int frames = 0;
};

/// A frame of which nothing was written.
struct FrameFailure {
    int frame = 0;
    std::string message;
    ErrorKind kind = ErrorKind::capture;
};

/// How one frame of a run ended.
struct FrameOutcome {
    enum class Kind { done, failed, skipped };
    int frame = 0;
    Kind kind = Kind::done;
    std::string message;  ///< why it failed, or how it differs from the first frame
    double seconds = 0;   ///< since the frame before ended
};

struct RunReport {
    int frames_done = 0;
    std::vector<FrameFailure> failures;
    std::vector<int> frames_non_finite;          ///< frames with NaN or infinite pixels, repaired ones too
    std::vector<std::string> objects_unmatched;  ///< ObjectMatches::unmatched()
    bool history_saved = false;                  ///< RunOptions::history_out was written
    int frames_skipped = 0;                      ///< missing, and MissingFrame::skip
    int frames_unwritten = 0;                    ///< rendered for what they leave to later frames
    int frames_current = 0;                      ///< finished by earlier runs; set by whoever leaves them out
    std::vector<PassStatistics> passes;          ///< in the order of the passes
    double read_ms = 0;                          ///< waiting for frames to be read and decoded
    double write_ms = 0;                         ///< waiting for files to be written
    double decode_ms = 0;                        ///< reading and decoding, on all threads together
    double encode_ms = 0;                        ///< encoding and writing, on its thread
    double wall_ms = 0;
    bool interrupted = false;
    gpu::ContextInfo gl;                    ///< of what the frames were drawn on
    std::string clock;                      ///< gpu::Timer::clock_name()
    std::vector<FrameTelemetry> telemetry;  ///< of every frame, where it was requested
    std::string graph_dot;                  ///< of the last frame, in Graphviz's language
    std::vector<DrawnPass> draws;           ///< likewise
    std::uint64_t bytes = 0;                ///< of its textures and buffers
    std::uint64_t bytes_unaliased = 0;      ///< what these would take if none shared memory
    gpu::TransferUse transfers;             ///< of all frames

    bool has_frames() const { return frames_done + frames_unwritten + frames_current > 0; }
    bool is_whole() const { return has_frames() && failures.empty() && !interrupted; }
};

/// Called on the caller's thread. Any may be empty.
struct RunObserver {
    std::function<void(const Capture&)> frame_started;
    std::function<void(const std::filesystem::path&)> file_written;
    std::function<void(const std::string&)> frame_failed;
    std::function<void(const CaptureHeader&, const std::vector<AuditFinding>&)> frame_audited;
    /// A sentence on NaN or infinite pixels of a capture or of an output, or on values that became infinite
    /// in a file.
    std::function<void(const std::string& message)> non_finite;
    /// A sentence on what a frame has otherwise than the first one: CaptureHeader::differences.
    std::function<void(const std::string& message)> frame_differs;
    std::function<void(const std::string& message)> light_cut;  ///< once, where a PNG cuts bright light
    std::function<void(int frame, const std::string& what)> frame_missing;  ///< skipped or held
    /// Frames but the first that restart history, where some step has history.
    std::function<void(int frame, const std::string& reason)> history_reset;
    std::function<void(int frame, const std::string& line)> native_message;
    /// An object that the look names was first missed, or found.
    std::function<void(const ObjectSighting&)> object_seen;
    /// Called for every frame except warm-up frames; for written frames, once their files are in place.
    std::function<void(const FrameOutcome&)> frame_finished;
};

}  // namespace aftershade
