// The files of farms: what their writers share, and the choice among them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "framework/batch/farm_job.h"

namespace aftershade {

/// sh, with the path of a script in the job's folder.
std::vector<std::string> farm_script(const FarmJob& job, const std::string& name);
/// In MiB, rounded up: the unit that all farms take.
std::uint64_t farm_mebibytes(const FarmJob& job);

// Each adds its files, the command and remarks.
void add_slurm_files(const FarmJob& job, FarmFiles& out);
void add_openjd_files(const FarmJob& job, FarmFiles& out);
void add_kubernetes_files(const FarmJob& job, FarmFiles& out);
void add_opencue_files(const FarmJob& job, FarmFiles& out);
void add_parallel_files(const FarmJob& job, FarmFiles& out);

/// "slurm", "openjd", "kubernetes", "opencue", "parallel"
const std::vector<std::string>& farm_names();

/// The files of one farm, with task.sh and merge.sh, which all of them start. Throws Error(usage) where the
/// farm cannot take the job, such as more tasks in a row than it has steps.
FarmFiles farm_files(std::string_view farm, const FarmJob& job);

}  // namespace aftershade
