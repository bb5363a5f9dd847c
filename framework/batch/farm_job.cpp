#include "framework/batch/farm_job.h"

#include <fmt/format.h>

#include <algorithm>

namespace aftershade {

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
