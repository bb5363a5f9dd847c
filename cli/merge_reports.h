// The reports of a farm's tasks as one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/batch_report.h"

namespace aftershade::cli {

struct MissingReport {
    std::string file;
    std::string why;  ///< as a message ends
};

struct MergedReport {
    BatchSummary batch;  ///< frames in order; seconds are the sum over the tasks
    int tasks = 0;
    std::vector<MissingReport> missing;  ///< also those that are not reports
};

/// A frame that several reports name is as the last of them has it. The exit code is `partial` where a frame
/// failed or was not run, or a report is missing.
MergedReport merge_reports(const std::vector<std::filesystem::path>& files);

/// A report of `run --report` with "tasks" and "missing_reports" besides.
std::string merged_report_json(const MergedReport& report);
/// "46 of 48 frames done, 2 failed; 12 of 12 tasks reported\n"
std::string merge_summary(const MergedReport& report);

}  // namespace aftershade::cli
