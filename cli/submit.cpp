#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/bound_look.h"
#include "cli/capture_options.h"
#include "cli/command_line.h"
#include "cli/job_options.h"
#include "cli/number_options.h"
#include "cli/run_arguments.h"
#include "cli/run_workers.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/diagnostics.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/batch/farm_files.h"
#include "framework/capture/frame_range.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

// The words of `aftershade submit`.

struct SubmitArguments {
    std::string farm;
    std::string look, capture;
    std::vector<std::string> outputs;
    std::vector<std::string> run_options;  ///< behind "--"
    int tasks = 0;                         ///< 0: by frames_per_task
    int frames_per_task = 0;               ///< 0: by the look
    std::string history = "auto";
    std::string folder = "aftershade-job";
    std::string name;     ///< "" for one after the look
    std::string program;  ///< "" for this one, or the image's
    int cpus = 1;
    std::uint64_t memory_bytes = 0;
    int minutes = 0;
    int retries = 2;
    std::string image, volume_claim, mount;
};

constexpr int kMostTasks = 1'000'000;  // as many frames as a sequence may have

void add_division_options(CLI::App& app, SubmitArguments& options) {
    auto* tasks = app.add_option("--tasks", options.tasks, "Number of tasks to divide the frames among")
                      ->check(CLI::Range(1, kMostTasks));
    app.add_option("--frames-per-task", options.frames_per_task,
                   "Frames per task (default: 10, or 4 times the warm-up if that is more)")
        ->check(CLI::Range(1, kMostTasks))
        ->excludes(tasks);
    app.add_option(
           "--history", options.history,
           "History of a task: exact (tasks run in turn and pass it on), warmup (a task first renders a few "
           "earlier frames), none, or auto (warmup if the look has history)")
        ->check(CLI::IsMember({"auto", "exact", "warmup", "none"}))
        ->capture_default_str();
}

void add_resource_options(CLI::App& app, SubmitArguments& options) {
    app.add_option("--cpus", options.cpus, "CPU cores per task")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    takes_bytes(app.add_option("--memory", options.memory_bytes,
                               "Memory per task, such as 4GB (default: the farm's)"));
    app.add_option("--time", options.minutes, "Time limit per task, in minutes (default: the farm's)")
        ->check(CLI::Range(1, 1'000'000));
    app.add_option("--retries", options.retries, "How often to retry a failed task")
        ->check(CLI::Range(0, 100))
        ->capture_default_str();
    app.add_option("--program", options.program,
                   "The aftershade program that tasks run (default: this one; in a container: aftershade)");
    app.add_option("--image", options.image, "kubernetes: the container image");
    app.add_option("--volume-claim", options.volume_claim,
                   "kubernetes: the PersistentVolumeClaim of the volume with the files");
    app.add_option("--mount", options.mount,
                   "kubernetes: the volume's mount folder, here and in the container (default: this folder)");
}

void add_submit_options(CLI::App& app, SubmitArguments& options) {
    app.add_option("--to", options.farm, "slurm, openjd, kubernetes, opencue or parallel")
        ->required()
        ->check(CLI::IsMember(farm_names()));
    app.add_option("look", options.look, "The look: a JSON file of effects in order")->required();
    app.add_option("capture", options.capture, "capture.json, a pattern such as frame_####.exr, or a folder")
        ->required();
    app.add_option("-o,--output", options.outputs, "Output pattern (.exr, .png); repeatable")
        ->required()
        ->allow_extra_args(false);
    app.add_option("options", options.run_options,
                   "After --: options of `aftershade run`, such as -- --frames 1-480 --set STEP.PARAM=VALUE");
    app.add_option("--folder", options.folder, "Folder for the job's files, new or empty")
        ->capture_default_str();
    app.add_option("--name", options.name, "The job's name (default: aftershade- and the look's name)");
    add_division_options(app, options);
    add_resource_options(app, options);
}

/// Absolute and normal, without a slash at its end. "" is this folder.
std::string absolute_path(const std::string& path) {
    std::string normal = fs::absolute(path.empty() ? "." : path).lexically_normal().string();
    while (normal.size() > 1 && normal.back() == '/') normal.pop_back();
    return normal;
}

/// The command line of `aftershade run` that the tasks divide among themselves, behind the program's name.
/// Looks, captures and outputs are absolute.
std::vector<std::string> run_words(const SubmitArguments& options) {
    std::vector<std::string> words{"run", absolute_path(options.look), absolute_path(options.capture)};
    for (const std::string& output : options.outputs)
        words.insert(words.end(), {"-o", absolute_path(output)});
    words.insert(words.end(), options.run_options.begin(), options.run_options.end());
    return words;
}

/// Options that tasks have of their own, and those of one farm without that farm.
void check_submit_options(const SubmitArguments& options, Diagnostics& diagnostics) {
    constexpr std::array kOfTasks{"--chunk", "--report",  "--history-in", "--history-out",
                                  "--watch", "--explain", "--dry-run"};
    for (const std::string& word : options.run_options)
        for (const std::string option : kOfTasks)
            if (word == option || word.starts_with(option + "="))
                diagnostics.error({"-- " + word}, "tasks of a farm cannot have this option; leave it out");
    if (options.farm == "kubernetes") {
        if (options.image.empty())
            diagnostics.error({"--to kubernetes"}, "needs --image, a container image with aftershade in it");
        if (options.volume_claim.empty())
            diagnostics.error({"--to kubernetes"},
                              "needs --volume-claim, the claim of a volume with the look and the capture");
        const std::string mount = absolute_path(options.mount);
        std::vector<std::string> paths{options.look, options.capture, options.folder};
        paths.insert(paths.end(), options.outputs.begin(), options.outputs.end());
        for (const std::string& path : paths)
            if (const fs::path below = fs::path(absolute_path(path)).lexically_relative(mount);
                below.empty() || *below.begin() == "..")
                diagnostics.error({path}, "does not lie below " + mount +
                                              ", the only folder that tasks see; move it there, or choose "
                                              "--mount");
    } else if (!options.image.empty() || !options.volume_claim.empty() || !options.mount.empty()) {
        diagnostics.error({"--to " + options.farm},
                          "has no containers; --image, --volume-claim and --mount are for kubernetes");
    }
    std::error_code failure;
    if (fs::exists(options.folder) && !fs::is_empty(options.folder, failure))
        diagnostics.error(
            {"--folder " + options.folder},
            "is not empty; choose another folder, or remove it: reports of an earlier job would "
            "count for this one");
}

constexpr int kLeastFrames = 10;         // a task starts and compiles shaders for seconds
constexpr int kWarmupFactor = 4;         // a quarter more frames rendered, at most
constexpr int kMostDefaultTasks = 1000;  // Slurm's default MaxArraySize allows no more

/// A DNS label of RFC 1123 with room for "-report": a-z, 0-9 and -.
std::string job_name(const std::string& wanted) {
    constexpr std::size_t kMost = 56;
    std::string name;
    for (const char c : wanted) {
        const bool plain =
            std::isalnum(static_cast<unsigned char>(c)) && static_cast<unsigned char>(c) < 0x80;
        if (plain) name += char(std::tolower(c));
        else if (!name.empty() && name.back() != '-') name += '-';
    }
    name.resize(std::min(name.size(), kMost));
    while (!name.empty() && name.back() == '-') name.pop_back();
    return name.empty() ? "aftershade" : name;
}

/// The run as its own command line gives it; nullopt after a fault.
std::optional<RunArguments> parse_run(const std::vector<std::string>& words, Diagnostics& diagnostics) {
    RunArguments run;
    CLI::App app{"", "aftershade run"};
    add_run_options(app, run);
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    reversed.pop_back();  // "run"
    try {
        app.parse(reversed);
    } catch (const CLI::ParseError& error) {
        diagnostics.error({"options of run"}, error.what());
        return std::nullopt;
    }
    return run;
}

/// Everything that `run` would refuse before it renders; then `run` has the division's own options. nullopt
/// after a fault.
std::optional<JobFrames> check_run(const SubmitArguments& options, RunArguments& run,
                                   Diagnostics& diagnostics) {
    const auto bound = bind_look(run, diagnostics);
    const std::vector<Profile> profiles = load_profiles(run.capture.profile_paths, diagnostics);
    auto sequence = find_sequence(run.capture, profiles, diagnostics);
    const RunOptions settings = run_options(run, diagnostics);
    if (sequence) add_missing_frames(run.capture, settings.missing, *sequence, diagnostics);
    const Sequence checked = sequence.value_or(Sequence{});
    InputFiles inputs = run_inputs(*bound, checked, diagnostics);
    check_run_outputs(run, output_options(run), checked, inputs, diagnostics);
    if (options.history == "exact" || options.history == "none") {
        if (run.jobs.warmup != "auto")
            diagnostics.error({"-- --warmup " + run.jobs.warmup},
                              "goes with --history warmup, not with --history " + options.history);
        run.jobs.warmup = "0";
    }
    if (options.history == "exact" && bound->pipeline.has_history()) run.history_out = "history";
    check_worker_options(run, diagnostics);
    if (!sequence) return std::nullopt;
    run.jobs.chunk = "1/1";
    return job_frames(run.jobs, bound->pipeline, *sequence, false, diagnostics);
}

FarmHistory history_of(const SubmitArguments& options, const JobFrames& run) {
    if (!run.has_history || options.history == "none") return FarmHistory::none;
    return options.history == "exact" ? FarmHistory::exact : FarmHistory::warmup;
}

int task_count(const SubmitArguments& options, const JobFrames& run) {
    const int frames = int(run.frames.size());
    if (options.tasks > 0) return std::min(options.tasks, frames);
    if (options.frames_per_task > 0) return (frames + options.frames_per_task - 1) / options.frames_per_task;
    const int per_task = std::max(kLeastFrames, run.has_history ? kWarmupFactor * run.warmup_frames : 0);
    return std::clamp(frames / per_task, 1, kMostDefaultTasks);
}

/// What the program reads from its environment here, and shall there.
std::map<std::string, std::string> environment_of(const SubmitArguments& options) {
    std::map<std::string, std::string> environment = own_variables();
    // Folders of this machine are not those of an image.
    if (options.farm == "kubernetes")
        std::erase_if(environment, [](const auto& variable) {
            return variable.first != "AFTERSHADE_BACKEND" && variable.first != "AFTERSHADE_DEVICE" &&
                   variable.first != "AFTERSHADE_DRAW_WITH" && variable.first != "AFTERSHADE_TRANSFERS";
        });
    return environment;
}

FarmJob farm_job(const SubmitArguments& options, const RunArguments& parsed, const JobFrames& run) {
    FarmJob job;
    job.name = job_name(options.name.empty() ? "aftershade-" + fs::path(options.look).stem().string()
                                             : options.name);
    job.program = !options.program.empty()       ? options.program
                  : options.farm == "kubernetes" ? "aftershade"
                                                 : fs::read_symlink("/proc/self/exe").string();
    job.arguments = run_words(options);
    // Tasks that start later divide the same frames, whatever lies in the folder by then.
    if (parsed.capture.frames.empty()) job.arguments.push_back("--frames=" + format_frame_range(run.frames));
    if (options.farm == "openjd" && parsed.progress == "auto")
        job.arguments.insert(job.arguments.end(), {"--progress", "openjd"});
    job.working_folder = fs::current_path();
    job.folder = absolute_path(options.folder);
    job.environment = environment_of(options);
    job.history = history_of(options, run);
    job.rows = farm_rows(run, task_count(options, run), job.history);
    job.cpus = options.cpus;
    job.memory_bytes = options.memory_bytes;
    job.minutes = options.minutes;
    job.retries = options.retries;
    job.image = options.image;
    job.volume_claim = options.volume_claim;
    job.mount = absolute_path(options.mount);
    return job;
}

void write_job(const FarmJob& job, const FarmFiles& files) {
    std::error_code failure;
    fs::create_directories(job.folder, failure);
    if (failure)
        throw Error(ErrorKind::output, job.folder.string() + ": cannot be made: " + failure.message());
    for (const char* folder : {"reports", "history", "logs"}) make_folder_below(job.folder, folder);
    for (const FarmFile& file : files.files) write_text_file(path_below(job.folder, file.name), file.text);
}

std::string division_text(const SubmitArguments& options, const JobFrames& run, const FarmJob& job) {
    const int frames = int(run.frames.size()), tasks = job.tasks();
    std::string text = fmt::format("{} in {} of about {}", counted(std::size_t(frames), "frame"),
                                   counted(std::size_t(tasks), "task"), (frames + tasks - 1) / tasks);
    if (options.tasks == 0 && options.frames_per_task == 0)
        text +=
            fmt::format(" (at least {}, and {} times the warm-up; choose with --tasks or --frames-per-task)",
                        kLeastFrames, kWarmupFactor);
    if (job.history == FarmHistory::warmup)
        text += fmt::format("; each renders up to {} frames before its own to warm history up",
                            run.warmup_frames);
    if (job.history == FarmHistory::exact)
        text += fmt::format("; exact history: {} of tasks, each task after the one before it",
                            counted(job.rows.size(), "row"));
    return text + "\n";
}

ExitCode submit(const SubmitArguments& options) {
    Diagnostics diagnostics;
    check_submit_options(options, diagnostics);
    auto run = parse_run(run_words(options), diagnostics);
    stop_at_errors(diagnostics);
    const auto frames = check_run(options, *run, diagnostics);
    stop_at_errors(diagnostics);
    if (frames->has_history && options.history == "none")
        diagnostics.warning({"--history none"},
                            "the look has history, which every task restarts: pictures change at the "
                            "borders of tasks");
    diagnostics.print(std::cerr);

    const FarmJob job = farm_job(options, *run, *frames);
    const FarmFiles files = farm_files(options.farm, job);
    write_job(job, files);
    std::cerr << division_text(options, *frames, job);
    for (const std::string& remark : files.remarks) std::cerr << "note: " << remark << "\n";
    std::cout << printed_command(files.submit) << "\n";
    return ExitCode::done;
}

}  // namespace

Verb add_submit(CLI::App& app) {
    auto options = std::make_shared<SubmitArguments>();
    add_submit_options(app, *options);
    return [options] { return submit(*options); };
}

}  // namespace aftershade::cli
