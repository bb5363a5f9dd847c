#include "cli/job_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/number_options.h"
#include "framework/base/cores.h"
#include "framework/base/whole_number.h"
#include "framework/document/units.h"
#include "framework/run/warmup.h"

namespace aftershade::cli {

namespace {

using Environment = std::function<const char*(const char*)>;

constexpr int kMostWorkers = 1024;

std::optional<int> number_of(const Environment& environment, const char* name) {
    const char* value = environment(name);
    return value ? whole_number(value) : std::nullopt;
}

/// The variables by which a farm numbers the tasks of an array.
struct ArrayVariables {
    const char *index, *first, *count, *last, *step;
};
constexpr ArrayVariables kFarms[] = {
    // https://slurm.schedmd.com/job_array.html
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_COUNT", "", "SLURM_ARRAY_TASK_STEP"},
    // https://kubernetes.io/docs/concepts/workloads/controllers/job/#completion-mode
    {"JOB_COMPLETION_INDEX", "", "", "", ""},
    // https://docs.aws.amazon.com/batch/latest/userguide/job_env_vars.html
    {"AWS_BATCH_JOB_ARRAY_INDEX", "", "AWS_BATCH_JOB_ARRAY_SIZE", "", ""},
    // qsub(1) of Grid Engine
    {"SGE_TASK_ID", "SGE_TASK_FIRST", "", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE"},
    {"PBS_ARRAY_INDEX", "", "", "", ""},
};

/// Index from 0, and the count where the farm says it.
struct FarmTask {
    int index = 0;
    std::optional<int> count;
};

std::optional<FarmTask> task_of(const Environment& environment) {
    for (const ArrayVariables& farm : kFarms) {
        const auto index = number_of(environment, farm.index);
        if (!index) continue;
        const auto value = [&](const char* name) {
            return *name ? number_of(environment, name) : std::nullopt;
        };
        const int first = value(farm.first).value_or(0), step = std::max(1, value(farm.step).value_or(1));
        std::optional<int> count = value(farm.count);
        if (const auto last = value(farm.last)) count = (*last - first) / step + 1;
        return FarmTask{(*index - first) / step, count};
    }
    return std::nullopt;
}

}  // namespace

void add_job_options(CLI::App& app, JobArguments& options) {
    app.add_option("--jobs", options.jobs, "Number of worker processes, or auto for one per core");
    app.add_option("--chunk", options.chunk,
                   "Render one part of the frames: 3/8 is the third of eight; auto/8 and auto take the "
                   "number from Slurm, Kubernetes, AWS Batch, PBS or Grid Engine");
    app.add_option("--warmup", options.warmup,
                   "Frames to render before a chunk without writing them, for looks with history: a number, "
                   "or auto for the number that the effects declare")
        ->capture_default_str();
    app.add_option("--frame-timeout", options.frame_timeout_s,
                   "Kill a worker that finishes no frame in this many seconds; its frame fails")
        ->check(CLI::Range(0.1, 1e6));
    takes_bytes(
        app.add_option("--max-memory", options.memory_bytes,
                       "Limit each worker's address space, such as 4GB; a frame that needs more fails"));
    app.add_flag("--stop-on-error", options.stop_on_error, "Stop at the first frame that fails");
    app.add_option("--report", options.report, "Write the outcome of each frame to this .json");
    // A worker's own, which no user needs.
    app.add_option("--worker-frames", options.worker_frames)->group("");
    app.add_option("--worker-warmup", options.worker_warmup_frames)->group("");
    app.add_option("--worker-threads", options.worker_threads)->group("");
}

std::optional<Chunk> parse_chunk(const std::string& text, const Environment& environment,
                                 Diagnostics& diagnostics) {
    const Place place{"--chunk " + text};
    const std::size_t slash = text.find('/');
    const std::string first = text.substr(0, slash);
    std::optional<int> index, count;
    if (slash != std::string::npos) count = whole_number(std::string_view(text).substr(slash + 1));
    if (first == "auto") {
        const auto task = task_of(environment);
        if (!task) {
            diagnostics.error(place,
                              "no variable of Slurm, Kubernetes, AWS Batch, PBS or Grid Engine numbers this "
                              "task; write the part, such as 3/8");
            return std::nullopt;
        }
        index = task->index;
        if (slash == std::string::npos) count = task->count;
        if (!count) {
            diagnostics.error(place, "the farm does not say how many tasks the array has; write auto/N");
            return std::nullopt;
        }
    } else if (const auto number = whole_number(first)) {
        index = *number - 1;
    }
    if (!index || !count || *count < 1 || *index < 0 || *index >= *count) {
        const std::string found =
            first == "auto" && index && count
                ? "task " + std::to_string(*index + 1) + " of " + std::to_string(*count) + " does not exist; "
                : "";
        diagnostics.error(place, found + "expected I/N with I from 1 to N, such as 3/8");
        return std::nullopt;
    }
    return Chunk{*index, *count};
}

JobFrames job_frames(const JobArguments& arguments, const Pipeline& pipeline, const Sequence& sequence,
                     bool has_saved_history, Diagnostics& diagnostics) {
    JobFrames run;
    run.frames = sequence.frames;
    run.cuts = sequence.cuts;
    run.has_history = pipeline.has_history();
    if (has_saved_history) return run;
    const LookWarmup declared = warmup_of(pipeline);
    run.warmup_frames = declared.frames;
    if (arguments.warmup != "auto") {
        const auto number = whole_number(arguments.warmup);
        if (!number || *number < 0 || *number > kMaxWarmupFrames)
            diagnostics.error({"--warmup " + arguments.warmup},
                              "expected auto or a number from 0 to " + std::to_string(kMaxWarmupFrames));
        run.warmup_frames = number.value_or(0);
    } else if (!declared.undeclared.empty() && arguments.divides_frames()) {
        diagnostics.error({"--warmup auto"}, "step " + list_of_names(declared.undeclared, "and") +
                                                 " has history and its effect declares no warm-up; write a "
                                                 "number, or render in one piece");
    }
    return run;
}

int worker_count(const JobArguments& arguments, const JobFrames& run, Diagnostics& diagnostics) {
    const int most = std::max(1, int(run.frames.size()));
    if (arguments.jobs.empty()) return 1;
    if (arguments.jobs == "auto") return std::min(allotted_cores(), most);
    const auto number = whole_number(arguments.jobs);
    if (!number || *number < 1 || *number > kMostWorkers)
        diagnostics.error({"--jobs " + arguments.jobs},
                          "expected auto or a number from 1 to " + std::to_string(kMostWorkers));
    return std::clamp(number.value_or(1), 1, most);
}

}  // namespace aftershade::cli
