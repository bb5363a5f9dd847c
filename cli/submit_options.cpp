#include "cli/submit_options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>

#include "cli/number_options.h"
#include "framework/batch/farm_files.h"
#include "framework/batch/farm_job.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

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

}  // namespace

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

std::string absolute_path(const std::string& path) {
    std::string normal = fs::absolute(path.empty() ? "." : path).lexically_normal().string();
    while (normal.size() > 1 && normal.back() == '/') normal.pop_back();
    return normal;
}

std::vector<std::string> run_words(const SubmitArguments& options) {
    std::vector<std::string> words{"run", absolute_path(options.look), absolute_path(options.capture)};
    for (const std::string& output : options.outputs)
        words.insert(words.end(), {"-o", absolute_path(output)});
    words.insert(words.end(), options.run_options.begin(), options.run_options.end());
    return words;
}

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

}  // namespace aftershade::cli
