#include <fmt/format.h>

#include "framework/base/text.h"
#include "framework/batch/farm_files.h"

namespace aftershade {

namespace {

/// https://slurm.schedmd.com/sbatch.html: options in the script; those of submit.sh's command line come
/// first.
std::string sbatch_lines(const std::string& name, int cpus, std::uint64_t mebibytes, int minutes) {
    std::string lines =
        fmt::format("#!/bin/sh\n#SBATCH --job-name={}\n#SBATCH --cpus-per-task={}\n", name, cpus);
    if (mebibytes > 0) lines += fmt::format("#SBATCH --mem={}M\n", mebibytes);
    if (minutes > 0) lines += fmt::format("#SBATCH --time={}\n", minutes);
    return lines;
}

std::string slurm_task_script(const FarmJob& job) {
    return sbatch_lines(job.name, job.cpus, farm_mebibytes(job), job.minutes) +
           fmt::format(
               "#SBATCH --array=1-{}\n"
               "#SBATCH --output=logs/%4a.log\n"
               "#SBATCH --open-mode=append\n"
               "#SBATCH --requeue\n"
               "# Slurm itself starts a task again after its node failed, and this script after the task "
               "did.\n"
               "# Part and count are written out, so that sbatch --array=3,7 job.sbatch makes these two "
               "again.\n"
               "code=0\n"
               "{} \"$SLURM_ARRAY_TASK_ID\" || code=$?\n"
               "# 1 (some frames), 2 (wrong usage or documents) and 130 (interrupted) would end the same "
               "again.\n"
               "case $code in 0 | 1 | 2 | 130) exit $code ;; esac\n"
               "[ \"${{SLURM_RESTART_COUNT:-0}}\" -ge {} ] || scontrol requeue \"$SLURM_JOB_ID\"\n"
               "exit $code\n",
               job.tasks(), shell_line(farm_script(job, "task.sh")), job.retries);
}

/// One array where no task waits for another; else a job for each task, behind the one before it in its row.
std::string slurm_submissions(const FarmJob& job) {
    if (job.history != FarmHistory::exact)
        return "jobs=:$(sbatch --parsable \"$@\" job.sbatch)\n"
               "jobs=${jobs%%;*}\n";
    std::string text =
        "jobs=\n"
        "# submit TASK: behind job $before, where there is one. Slurm keeps the order through requeues. A "
        "task\n"
        "# whose predecessor left no history fails at once.\n"
        "submit() {\n"
        "    task=$1\n"
        "    shift\n"
        "    job=$(sbatch --parsable --array=\"$task\" ${before:+--dependency=afterany:$before} \"$@\" "
        "job.sbatch)\n"
        "    before=${job%%;*}\n"
        "    jobs=$jobs:$before\n"
        "}\n";
    for (const std::vector<int>& row : job.rows) {
        std::string tasks;
        for (const int task : row) tasks += " " + std::to_string(task);
        text += "before=\nfor number in" + tasks + "; do submit \"$number\" \"$@\"; done\n";
    }
    return text;
}

std::string slurm_submit_script(const FarmJob& job) {
    return fmt::format(
        "#!/bin/sh\n"
        "# Submits the tasks, and a job that merges their reports. Arguments go to sbatch: "
        "--partition=night\n"
        "set -eu\n"
        "cd {}\n"
        "{}"
        "merge=$(sbatch --parsable --dependency=afterany\"$jobs\" \"$@\" merge.sbatch)\n"
        "echo \"tasks: ${{jobs#:}}; report: job ${{merge%%;*}}\"\n",
        shell_line({job.folder.string()}), slurm_submissions(job));
}

}  // namespace

void add_slurm_files(const FarmJob& job, FarmFiles& out) {
    constexpr int kDefaultMaxArraySize = 1001;  // https://slurm.schedmd.com/slurm.conf.html
    out.files.push_back({"job.sbatch", slurm_task_script(job)});
    out.files.push_back({"merge.sbatch", sbatch_lines(job.name + "-report", 1, 0, 0) +
                                             "#SBATCH --output=logs/report.log\nexec " +
                                             shell_line(farm_script(job, "merge.sh")) + "\n"});
    out.files.push_back({"submit.sh", slurm_submit_script(job)});
    out.submit = farm_script(job, "submit.sh");
    if (job.tasks() >= kDefaultMaxArraySize)
        out.remarks.push_back(
            fmt::format("Slurm accepts task numbers below its MaxArraySize, which is {} unless the site has "
                        "raised it; this "
                        "job has {} tasks",
                        kDefaultMaxArraySize, job.tasks()));
}

}  // namespace aftershade
