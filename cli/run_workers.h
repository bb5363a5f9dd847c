// `run` with worker processes.
#pragma once

#include <atomic>

#include "cli/run_arguments.h"
#include "cli/run_messages.h"
#include "framework/base/error.h"
#include "framework/batch/job_plan.h"
#include "framework/batch/process_codes.h"
#include "framework/look/pipeline.h"

namespace aftershade::cli {

/// What workers cannot do together, because it needs all frames in one process.
void check_worker_options(const RunArguments& arguments, Diagnostics& diagnostics);

/// Renders the frames by `workers` processes, reports progress and how each frame ended.
ExitCode run_by_workers(const RunArguments& arguments, const JobFrames& frames, int workers,
                        const Pipeline& pipeline, ProgressStyle progress, const std::atomic<bool>& stop);

}  // namespace aftershade::cli
