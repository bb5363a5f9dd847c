// What `run` tells a person: progress while it works, and the time of each pass at the end. All on stderr;
// stdout holds the paths of the files written, one a line.
#pragma once

#include <set>
#include <string>

#include "framework/pipeline/run.h"

namespace aftershade::cli {

enum class ProgressStyle { none, plain, terminal };

/// "auto" is a terminal's line where stderr is one, else plain. Throws Error(ExitCode::usage).
ProgressStyle parse_progress(const std::string& name);

class RunReporter {
public:
    RunReporter(ProgressStyle style, int frame_count) : style_(style), frame_count_(frame_count) {}

    RunObserver observer();
    void print_summary(const RunReport& report, const std::string& clock);

private:
    void clear_line();
    ProgressStyle style_;
    int frame_count_ = 0;
    int started_ = 0;
    bool has_line_ = false;
    std::string profile_;
    std::set<std::string> notes_;  ///< that have been told
};

}  // namespace aftershade::cli
