#include "cli/serve_export.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>

#include "cli/command_line.h"
#include "cli/plugin_options.h"
#include "cli/run_session.h"
#include "framework/base/atomic_file.h"
#include "framework/base/path_bounds.h"
#include "framework/base/text.h"
#include "framework/batch/worker.h"
#include "framework/capture/frame_range.h"

namespace aftershade::cli {

namespace fs = std::filesystem;

namespace {

// No path has a NUL in it.
constexpr char kBetween = '\0';

std::string text_of(const serve::ExportJob& job) {
    std::string text;
    for (const std::string& one : {job.look.string(), job.look_folder.string(), job.capture,
                                   job.output.string(), format_frame_range(job.frames)})
        text += one + kBetween;
    for (const std::string& file : job.files) text += file + kBetween;
    return text;
}

fs::path job_file(const fs::path& folder) {
    return folder / "job";
}

/// What the page says of the process: its lines without warnings. The terminal has them all.
class Faults {
public:
    void add(std::string_view line) {
        constexpr std::size_t kLongest = 2000;  // bytes: a page shows it
        if (line.find(": warning: ") != std::string_view::npos || text_.size() + line.size() > kLongest)
            return;
        for (const std::string_view head : {"aftershade: error: ", "aftershade: "})
            if (line.starts_with(head)) line.remove_prefix(head.size());
        text_ += (text_.empty() ? "" : "; ") + std::string(line);
    }
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

}  // namespace

serve::RunExport export_runner(PassLimit limit) {
    return [limit](const serve::ExportJob& job, const std::function<void()>& frame_done,
                   const std::atomic<bool>& cancel) -> std::string {
        const fs::path folder = job.look.parent_path();
        write_text_file(job_file(folder), text_of(job));
        WorkerCommand command;
        command.arguments = own_arguments();
        command.arguments[0] = "/proc/self/exe";
        command.environment[kExportVariable] = folder.string();
        command.limits.resident_bytes = foreign_memory_bytes();
        Watchdog watchdog(Watchdog::Duration::max(), limit, cancel);
        Faults faults;
        WorkerListener listener;
        listener.on_status = [&](const WorkStatus& status) { watchdog.is_at(status); };
        listener.on_stderr = [&](std::string_view line) {
            faults.add(line);
            std::cerr << std::string(line) + "\n";
        };
        listener.on_frame = [&](const FrameEvent& event) {
            if (event.outcome == "done") frame_done();
        };
        const WorkerResult result = run_worker(command, listener, &watchdog.flag());
        if (result.ended_in_order() && result.exit_code == int(ExitCode::done)) return "";
        if (watchdog.barked()) return describe_timeout(result, watchdog.timeout());
        return faults.text().empty() ? describe(result) : faults.text();
    };
}

serve::ExportJob read_export_job() {
    const std::string text = read_text_file(job_file(std::getenv(kExportVariable)), ErrorKind::usage);
    auto words = split(text, kBetween);
    if (words.size() < 6) throw Error(ErrorKind::usage, std::string(kExportVariable) + " names no export");
    serve::ExportJob job{words[0], words[1], std::string(words[2]), words[3], {}, {}};
    job.frames = parse_frame_range(words[4]).value_or(std::vector<int>());
    job.files.assign(words.begin() + 5, words.end() - 1);  // the last one stands behind the last NUL
    return job;
}

ExitCode run_export(const serve::ExportJob& job, RunArguments arguments) {
    constexpr int kLessUrgent = 10;  // than the pictures of the page
    setpriority(PRIO_PROCESS, 0, kLessUrgent);
    arguments.look = job.look.string();
    // Those of the page, which leaves out what is missing.
    arguments.capture.frames = format_frame_range(job.frames);
    arguments.look_folder = job.look_folder.string();
    arguments.outputs = {job.output.string()};
    arguments.progress = "none";
    arguments.resume.no_journal = true;
    const FileRule rule([&](const fs::path& file) -> std::string {
        const bool may = std::ranges::find(job.files, resolved_path(file).string()) != job.files.end();
        return may ? "" : "is not a file that the look named";
    });
    return run(arguments);
}

}  // namespace aftershade::cli
