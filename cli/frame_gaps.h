// Frames that a pattern lacks between its first and its last.
#pragma once

#include "cli/capture_options.h"
#include "framework/base/diagnostics.h"
#include "framework/capture/sequence.h"
#include "framework/run/run_options.h"

namespace aftershade::cli {

/// Where the frames are what lies on disk, not what the user named: adds those that are missing in between,
/// so that `missing` decides on them, and says which they are where that makes them failures.
void add_missing_frames(const CaptureOptions& options, MissingFrame missing, Sequence& sequence,
                        Diagnostics& diagnostics);

}  // namespace aftershade::cli
