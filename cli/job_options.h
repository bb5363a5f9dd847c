// Worker processes and chunks of `run`.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "cli/cli11.h"
#include "framework/base/diagnostics.h"
#include "framework/batch/job_plan.h"
#include "framework/capture/sequence.h"
#include "framework/look/pipeline.h"

namespace aftershade::cli {

struct JobArguments {
    std::string jobs;  ///< "4", "auto"; "": no worker processes
    std::string chunk;
    std::string warmup = "auto";
    double frame_timeout_s = 0;      ///< 0: none
    std::uint64_t memory_bytes = 0;  ///< 0: no limit
    bool stop_on_error = false;
    std::string report;
    // What a worker is started with.
    std::string worker_frames;
    int worker_warmup_frames = 0;
    int worker_threads = 0;

    bool is_worker() const { return !worker_frames.empty(); }
    /// Whether frames go to several processes or machines.
    bool divides_frames() const { return !chunk.empty() || (!jobs.empty() && jobs != "1"); }
    /// Whether frames are rendered by other processes.
    bool wants_workers() const {
        return !is_worker() && (!jobs.empty() || frame_timeout_s > 0 || memory_bytes > 0);
    }
};

void add_job_options(CLI::App& app, JobArguments& arguments);

/// One piece of how many, as "--chunk" or a farm's environment has it.
struct Chunk {
    int index = 0;  ///< from 0
    int count = 1;
};
/// "3/8" (the first is 1/8); "auto" and "auto/8" take the index, and "auto" the count too, from the variables
/// of Slurm, Kubernetes, AWS Batch, PBS or Grid Engine. nullopt after a fault.
std::optional<Chunk> parse_chunk(const std::string& text,
                                 const std::function<const char*(const char*)>& environment,
                                 Diagnostics& diagnostics);

/// The run as far as its division matters. `has_saved_history`: it continues from a file and needs no
/// warm-up.
JobFrames job_frames(const JobArguments& arguments, const Pipeline& pipeline, const Sequence& sequence,
                     bool has_saved_history, Diagnostics& diagnostics);

/// "auto" or a number; at most as many as there are frames.
int worker_count(const JobArguments& arguments, const JobFrames& run, Diagnostics& diagnostics);

}  // namespace aftershade::cli
