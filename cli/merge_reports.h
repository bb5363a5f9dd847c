// The reports of a farm's tasks as one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/batch_report.h"

namespace aftershade::cli {

struct TaskReport {
    std::filesystem::path folder;  ///< that the user named, with the reports of a run's tasks; "" for none
    std::filesystem::path name;    ///< in it; without one as the user named it
    std::filesystem::path path() const { return folder / name; }
};

struct MissingReport {
    std::string file;
    std::string why;  ///< as a message ends
};

struct MergedReport {
    BatchSummary batch;  ///< frames in order; seconds are the sum over the tasks
    int tasks = 0;
    std::vector<MissingReport> missing;  ///< also those that are not reports
    std::vector<MissingReport> failed;   ///< whose run ended with an error that no frame has
};

/// A frame that several reports name is as the last of them has it; tasks divide their frames, so of one
/// folder the second report that names a frame does not count. The exit code is `partial` where a frame
/// failed or was not run, a report is missing, or a run ended with an error and no later report has its
/// frames.
MergedReport merge_reports(const std::vector<TaskReport>& files);

/// A report of `run --report` with "tasks" and "missing_reports" besides.
std::string merged_report_json(const MergedReport& report);
/// "46 of 48 frames done, 2 failed; 12 of 12 tasks reported\n"
std::string merge_summary(const MergedReport& report);

}  // namespace aftershade::cli
