#include "framework/batch/farm_files.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "framework/base/text.h"

namespace aftershade {

namespace {

struct Farm {
    const char* name;
    void (*add_files)(const FarmJob& job, FarmFiles& out);
};
constexpr std::array kFarms{Farm{"slurm", add_slurm_files}, Farm{"openjd", add_openjd_files},
                            Farm{"kubernetes", add_kubernetes_files}, Farm{"opencue", add_opencue_files},
                            Farm{"parallel", add_parallel_files}};

/// What the tasks of a run that hands history on do besides: each begins with what the one before it wrote.
std::string history_lines(const FarmJob& job) {
    if (job.history != FarmHistory::exact) return "";
    std::string first;
    for (const std::vector<int>& row : job.rows)
        first += (first.empty() ? "" : "|") + std::to_string(row.front());
    const std::string folder = shell_line({(job.folder / "history").string()});
    return fmt::format(
        "history={}\n"
        "# A history of an earlier try must not pass for this one's.\n"
        "rm -f \"$history/$name\"\n"
        "# A run whose frames are all current saves no history for the next task.\n"
        "set -- --overwrite --history-out \"$history/$name\"\n"
        "case $task in\n"
        "{}) ;; # begins a shot\n"
        "*) set -- \"$@\" --history-in \"$history/$(printf %04d $((task - 1)))\" ;;\n"
        "esac\n",
        folder, first);
}

std::string task_script(const FarmJob& job) {
    std::vector<std::string> command{job.program};
    command.insert(command.end(), job.arguments.begin(), job.arguments.end());
    if (job.history != FarmHistory::warmup) command.insert(command.end(), {"--warmup", "0"});
    std::string variables;
    for (const auto& [name, value] : job.environment)
        variables += "export " + name + "=" + shell_line({value}) + "\n";
    return fmt::format(
        "#!/bin/sh\n"
        "# sh task.sh N: renders part N of {} of the frames, and reports how each frame ended.\n"
        "set -u\n"
        "task=$1\n"
        "name=$(printf %04d \"$task\")\n"
        "cd {} || exit 6\n"
        "{}"
        "# Mesa starts a thread for each core of the machine unless this variable is set.\n"
        "export LP_NUM_THREADS=\"${{LP_NUM_THREADS:-{}}}\"\n"
        "set --\n"
        "{}"
        "exec {} --chunk \"$task/{}\" --report {}/reports/\"$name\".json \"$@\"\n",
        job.tasks(), shell_line({job.working_folder.string()}), variables, job.cpus, history_lines(job),
        shell_line(command), job.tasks(), shell_line({job.folder.string()}));
}

/// For farms that order no tasks: a row in turn. A row that is tried again goes on behind what is complete.
std::string row_script(const FarmJob& job) {
    return fmt::format(
        "#!/bin/sh\n"
        "# sh row.sh N...: renders these parts in turn, but for those that an earlier try has ended.\n"
        "set -u\n"
        "worst=0\n"
        "for task in \"$@\"; do\n"
        "    name=$(printf %04d \"$task\")\n"
        "    [ -e {0}/history/\"$name\" ] && [ -e {0}/reports/\"$name\".json ] && continue\n"
        "    code=0\n"
        "    sh {0}/task.sh \"$task\" || code=$?\n"
        "    # After 1, some frames failed, the history of the others is there.\n"
        "    [ \"$code\" -le 1 ] || exit \"$code\"\n"
        "    [ \"$code\" -eq 0 ] || worst=1\n"
        "done\n"
        "exit $worst\n",
        shell_line({job.folder.string()}));
}

std::string merge_script(const FarmJob& job) {
    return "#!/bin/sh\n"
           "# Makes one report of those of the tasks; exit 1 where frames failed or tasks have no report.\n"
           "exec " +
           shell_line({job.program, "merge", (job.folder / "reports").string(), "--tasks",
                       std::to_string(job.tasks()), "-o", (job.folder / "report.json").string()}) +
           "\n";
}

}  // namespace

const std::vector<std::string>& farm_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Farm& farm : kFarms) all.push_back(farm.name);
        return all;
    }();
    return names;
}

FarmFiles farm_files(std::string_view farm, const FarmJob& job) {
    FarmFiles out;
    out.files = {{"task.sh", task_script(job)}, {"merge.sh", merge_script(job)}};
    if (job.history == FarmHistory::exact) out.files.push_back({"row.sh", row_script(job)});
    for (const Farm& known : kFarms)
        if (known.name == farm) known.add_files(job, out);
    return out;
}

std::vector<std::string> farm_script(const FarmJob& job, const std::string& name) {
    return {"sh", (job.folder / name).string()};
}

std::uint64_t farm_mebibytes(const FarmJob& job) {
    constexpr std::uint64_t kMebibyte = 1 << 20;
    return (job.memory_bytes + kMebibyte - 1) / kMebibyte;
}

int FarmJob::tasks() const {
    int last = 0;
    for (const std::vector<int>& row : rows) last = std::max(last, row.back());
    return last;
}

std::vector<std::vector<int>> farm_rows(const JobFrames& run, int tasks, FarmHistory history) {
    JobFrames parts = run;
    parts.warmup_frames = 0;
    std::vector<std::vector<int>> rows;
    int last_frame = 0;
    for (int task = 1; task <= tasks; ++task) {
        const std::vector<int> frames = chunk_of(parts, task - 1, tasks).frames;
        // History restarts at a cut and after a gap in the frame numbers.
        const bool goes_on = history == FarmHistory::exact && task > 1 && frames.front() == last_frame + 1 &&
                             std::find(run.cuts.begin(), run.cuts.end(), frames.front()) == run.cuts.end();
        if (!goes_on) rows.emplace_back();
        rows.back().push_back(task);
        last_frame = frames.back();
    }
    return rows;
}

std::string task_name(int task) {
    return fmt::format("{:04}", task);
}

}  // namespace aftershade
