// How many processor cores this process may use.
#pragma once

#include <filesystem>
#include <string>

namespace aftershade {

/// Cores of the process's affinity mask (taskset, Slurm), at most what its control group grants (containers'
/// `--cpus`, cgroup v1 and v2), rounded up; at least 1.
int allotted_cores();

/// The processor share of a control group and of those above it, in cores; infinity without a limit. `groups`
/// is the text of /proc/self/cgroup, `root` where control groups are mounted.
double granted_cores(const std::string& groups, const std::filesystem::path& root);

}  // namespace aftershade
