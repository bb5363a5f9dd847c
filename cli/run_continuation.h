// How an interrupted run resumes; and what a run lacks: history where it begins in the middle of a shot,
// changes of color in layers.
#pragma once

#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/pipeline/pipeline.h"
#include "framework/pipeline/run.h"

namespace aftershade::cli {

/// The message after an interrupt: how far the run came, and the command that does the rest, in a line of
/// its own. With history that was not saved, the rest begins where the history began, so that its pictures
/// are those of an uncut run. "" where nothing is left.
std::string continuation_text(const std::vector<std::string>& command, const RunOptions& run,
                              const RunReport& report);

/// A warning where the first frame is not the first of its shot and there is no history to continue from; ""
/// if all is well, or if the look has no history.
std::string lost_history_text(const Pipeline& pipeline, const Sequence& sequence, const CaptureReader& reader,
                              const RunOptions& run);

/// Warnings where the capture has layers and a step reads them after others have changed the picture's color;
/// none if the first frame cannot be read.
std::vector<std::string> stale_layers_texts(const Pipeline& pipeline, const Sequence& sequence,
                                            const CaptureReader& reader);

}  // namespace aftershade::cli
