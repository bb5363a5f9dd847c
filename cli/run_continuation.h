// How an interrupted run resumes; and what a run lacks: history where it begins in the middle of a shot,
// changes of color in layers.
#pragma once

#include <string>
#include <vector>

#include "cli/run_arguments.h"
#include "cli/run_messages.h"
#include "framework/capture/capture.h"
#include "framework/look/pipeline.h"

namespace aftershade::cli {

/// How far an interrupted run came.
struct Interruption {
    int done = 0;              ///< frames that are finished, by earlier runs too
    int frames = 0;            ///< that the run was to write
    bool is_complete = false;  ///< nothing is left
    bool has_history = false;
};

/// Says so, with the command that does the rest in a line of its own, last: the run's own command, since the
/// journal has what is done and where history can start.
void print_interruption(ProgressStyle style, const RunArguments& run, const Interruption& end);

/// A warning where `first`, which begins a run of frames without history, is not the first of its shot; "" if
/// it is. The pipeline has history.
std::string lost_history_text(const Pipeline& pipeline, const Sequence& sequence, const CaptureReader& reader,
                              int first, const std::string& remedy);

/// Warnings where the capture has layers and a step reads them after others have changed the picture's color;
/// none if the first frame cannot be read.
std::vector<std::string> stale_layers_texts(const Pipeline& pipeline, const Sequence& sequence,
                                            const CaptureReader& reader);

}  // namespace aftershade::cli
