#include <fmt/format.h>

#include "framework/base/text.h"
#include "framework/batch/farm_files.h"

namespace aftershade {

namespace {

// https://docs.opencue.io/docs/reference/pyoutline-api

/// A list of Python, of literals that are JSON's too.
std::string python_rows(const FarmJob& job) {
    std::string text;
    for (const std::vector<int>& row : job.rows) {
        text += text.empty() ? "[" : ",\n        [";
        for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? ", " : "") + std::to_string(row[i]);
        text += "]";
    }
    return "[" + text + "]";
}

/// What every layer of tasks asks of a host.
std::string opencue_arguments(const FarmJob& job) {
    std::string text = fmt::format("cores={}", job.cpus);
    if (job.memory_bytes > 0) text += fmt::format(", memory=\"{}m\"", farm_mebibytes(job));
    return text;
}

std::string opencue_layers(const FarmJob& job, const std::string& task) {
    if (job.history != FarmHistory::exact)
        return fmt::format("    Shell(\"frames\", command={}, range=\"1-{}\", {})\n",
                           json_string(task + " #IFRAME#"), job.tasks(), opencue_arguments(job));
    return fmt::format(
        "    # A layer for each task: only layers wait for one another.\n"
        "    rows = {}\n"
        "    for row in rows:\n"
        "        before = None\n"
        "        for task in row:\n"
        "            layer = Shell(\"part_%04d\" % task, command={} % task, range=\"1-1\", {})\n"
        "            if before:\n"
        "                layer.depend_all(before)\n"
        "            before = layer\n",
        python_rows(job), json_string(task + " %d"), opencue_arguments(job));
}

}  // namespace

void add_opencue_files(const FarmJob& job, FarmFiles& out) {
    std::string task = shell_line(farm_script(job, "task.sh"));
    if (job.minutes > 0) task = fmt::format("timeout {}m {}", job.minutes, task);
    std::string format = task;  // of Python's %
    if (job.history == FarmHistory::exact)
        for (std::size_t at = format.find('%'); at != std::string::npos; at = format.find('%', at + 2))
            format.insert(at, "%");
    out.files.push_back(
        {"job.py",
         fmt::format("#!/usr/bin/env python3\n"
                     "# Launches the job with PyOutline (pip install opencue-pyoutline), on the Cuebot of\n"
                     "# $CUEBOT_HOSTS.\n"
                     "import outline\n"
                     "import outline.cuerun\n"
                     "from outline.layer import OutlinePostCommand\n"
                     "from outline.modules.shell import Shell\n"
                     "\n\n"
                     "def make():\n"
                     "    job = outline.Outline({}, current=True)\n"
                     "{}"
                     "    # Starts when every other layer has ended, also after failures.\n"
                     "    OutlinePostCommand(\"report\", command={}, range=\"1-1\")\n"
                     "    return job\n"
                     "\n\n"
                     "def launcher(**options):\n"
                     "    return outline.cuerun.OutlineLauncher(make(), maxretries={}, **options)\n"
                     "\n\n"
                     "if __name__ == \"__main__\":\n"
                     "    launcher().launch(use_pycuerun=False)\n",
                     json_string(job.name), opencue_layers(job, format),
                     json_string(shell_line(farm_script(job, "merge.sh"))), job.retries)});
    out.submit = {"python3", (job.folder / "job.py").string()};
}

}  // namespace aftershade
