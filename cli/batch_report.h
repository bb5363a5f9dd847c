// How the frames of a run ended, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/base/status.h"
#include "framework/batch/process_codes.h"
#include "framework/run/run_frames.h"

namespace aftershade::cli {

struct BatchSummary {
    std::string look, capture;
    std::vector<FrameEvent> frames;
    double seconds = 0;
    ExitCode exit_code = ExitCode::done;
    DrawnBy gl{};         ///< empty where nothing was drawn
    std::string error{};  ///< the message of what ended the run; "" where nothing did
};

/// The outcomes of a run in this process; frames without one are "not run" unless they are current.
std::vector<FrameEvent> frame_events(const RunOptions& run, const std::vector<FrameOutcome>& outcomes,
                                     const std::vector<int>& current);
FrameEvent frame_event(const FrameOutcome& outcome);

int count_outcome(const std::vector<FrameEvent>& frames, const std::string& outcome);

/// Frames that were not run say why, unless they have a message of their own.
/// {"look": ..., "frames": [{"frame": 12, "outcome": "failed", "seconds": 0.4, "message": "..."}], ...}
std::string report_json(const BatchSummary& summary);

/// "2 of 48 frames failed:" and a line for each; "" where none failed.
std::string failures_text(const std::vector<FrameEvent>& frames);

}  // namespace aftershade::cli
