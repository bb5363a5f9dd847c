#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>

#include "cli/batch_report.h"
#include "cli/merge_reports.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/text.h"
#include "framework/batch/farm_job.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

struct MergeArguments {
    std::vector<std::string> reports;
    std::string output;
    int tasks = 0;  ///< 0: as many as there are reports
};

bool is_same(const fs::path& a, const fs::path& b) {
    std::error_code absent;
    return fs::equivalent(a, b, absent);
}

/// The files meant: each as it is named; of a folder, those of its tasks.
std::vector<TaskReport> report_files(const MergeArguments& options) {
    std::vector<TaskReport> files;
    for (const std::string& name : options.reports) {
        if (!fs::is_directory(name)) {
            files.push_back({"", name});
        } else if (options.tasks > 0) {
            for (int task = 1; task <= options.tasks; ++task)
                files.push_back({name, task_name(task) + ".json"});
        } else {
            std::set<fs::path> sorted;
            for (const auto& entry : fs::directory_iterator(name))
                if (entry.path().extension() == ".json" && !is_same(entry.path(), options.output))
                    sorted.insert(entry.path().filename());
            for (const fs::path& file : sorted) files.push_back({name, file});
        }
    }
    return files;
}

ExitCode merge(const MergeArguments& options) {
    const std::vector<TaskReport> files = report_files(options);
    if (files.empty()) throw Error(ErrorKind::capture, options.reports.front() + ": holds no report (.json)");
    const MergedReport merged = merge_reports(files);
    write_text_file(options.output, merged_report_json(merged));
    for (const auto* faults : {&merged.missing, &merged.failed})
        for (const MissingReport& report : *faults)
            std::cerr << printable(report.file + ": " + report.why) << "\n";
    std::cerr << failures_text(merged.batch.frames) << merge_summary(merged);
    return merged.batch.exit_code;
}

}  // namespace

Verb add_merge(CLI::App& app) {
    auto options = std::make_shared<MergeArguments>();
    app.add_option("reports", options->reports,
                   "Reports of run --report, or a folder of them; for a frame in several, the last counts")
        ->required();
    app.add_option("-o,--output", options->output, "Write the merged report to this .json")->required();
    app.add_option("--tasks", options->tasks,
                   "Number of reports to expect in the folder: 0001.json, 0002.json, ...")
        ->check(CLI::PositiveNumber);
    return [options] { return merge(*options); };
}

}  // namespace aftershade::cli
