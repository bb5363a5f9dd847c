// How many processor cores this process may use, what they are, and what its control groups allow it.
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

/// Limits of a control group and of those above it, without which a number is infinite. Arguments as those of
/// granted_cores.
struct GroupLimits {
    double memory_bytes = 0;
    double threads = 0;  ///< of all processes together
};
GroupLimits group_limits(const std::string& groups, const std::filesystem::path& root);
/// Those of this process.
GroupLimits group_limits();

/// "model name" of /proc/cpuinfo, or "unknown".
std::string cpu_model();
/// The processor's instructions that change bits of a software renderer, as in "x86-64 with FMA". A variable
/// that makes Mesa use fewer of them counts.
std::string cpu_instructions();

}  // namespace aftershade
