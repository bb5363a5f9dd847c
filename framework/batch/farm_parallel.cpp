#include <fmt/format.h>

#include "framework/base/text.h"
#include "framework/batch/farm_files.h"

namespace aftershade {

namespace {

std::string parallel_commands(const FarmJob& job) {
    const std::string script = job.history == FarmHistory::exact ? "row.sh" : "task.sh";
    std::string lines;
    for (const std::vector<int>& row : job.rows) {
        std::vector<std::string> words = farm_script(job, script);
        for (const int task : row) words.push_back(std::to_string(task));
        lines += shell_line(words) + "\n";
    }
    return lines;
}

std::string parallel_run_script(const FarmJob& job) {
    std::vector<std::string> options{"--joblog", "joblog", "--resume-failed", "--retries",
                                     std::to_string(job.retries + 1)};  // of GNU parallel: tries in all
    const std::size_t row =
        job.history == FarmHistory::exact ? std::size_t(job.tasks()) / job.rows.size() : 1;
    if (job.minutes > 0)
        options.insert(options.end(), {"--timeout", std::to_string(std::size_t(job.minutes) * 60 * row)});
    if (job.memory_bytes > 0)
        options.insert(options.end(), {"--memfree", std::to_string(farm_mebibytes(job)) + "M"});
    return fmt::format(
        "#!/bin/sh\n"
        "# Runs the tasks on this machine and merges their reports. Started again, it makes those that have "
        "not\n"
        "# succeeded. Arguments go to parallel (https://www.gnu.org/software/parallel/man.html).\n"
        "set -u\n"
        "cd {} || exit 6\n"
        "slots=$(($(nproc) / {}))\n"
        "parallel --jobs $((slots > 0 ? slots : 1)) {} \"$@\" <commands.txt\n"
        "exec sh merge.sh\n",
        shell_line({job.folder.string()}), job.cpus, shell_line(options));
}

}  // namespace

void add_parallel_files(const FarmJob& job, FarmFiles& out) {
    out.files.push_back({"commands.txt", parallel_commands(job)});
    out.files.push_back({"run.sh", parallel_run_script(job)});
    out.submit = farm_script(job, "run.sh");
}

}  // namespace aftershade
