#include "framework/base/cores.h"

#include <sched.h>
#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>
#include <thread>

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

int cores_of_affinity() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
    return std::max(1, int(std::thread::hardware_concurrency()));
}

double share(double quota_us, double period_us) {
    return quota_us > 0 && period_us > 0 ? quota_us / period_us : kNoLimit;
}

/// "max 100000" or "150000 100000".
double share_of_v2(const fs::path& folder) {
    std::ifstream file(folder / "cpu.max");
    double quota_us = 0, period_us = 0;
    return file >> quota_us >> period_us ? share(quota_us, period_us) : kNoLimit;
}

double share_of_v1(const fs::path& folder) {
    std::ifstream quota(folder / "cpu.cfs_quota_us"), period(folder / "cpu.cfs_period_us");
    double quota_us = 0, period_us = 0;
    return quota >> quota_us && period >> period_us ? share(quota_us, period_us) : kNoLimit;
}

/// "max" or a number of bytes or threads; version 1 writes a number near the greatest for "max".
double number_in(const fs::path& file) {
    std::ifstream in(file);
    double number = 0;
    return in >> number && number < 9e18 ? number : kNoLimit;
}

using Share = double (*)(const fs::path& folder);

/// The least of a group's share and of all groups above it. In a container the group's own folder is the
/// root.
double least_share(const fs::path& root, fs::path group, Share share_of) {
    double least = share_of(root);
    for (; group.has_relative_path(); group = group.parent_path())
        least = std::min(least, share_of(root / group.relative_path()));
    return least;
}

double least_share(const std::string& groups, const fs::path& root, const std::string& controller,
                   Share of_v1, Share of_v2) {
    double least = kNoLimit;
    std::istringstream lines(groups);
    // "0::/user.slice" of version 2; "4:cpu,cpuacct:/docker/1f" of version 1.
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const fs::path group = line.substr(second + 1);
        if (controllers.empty()) least = std::min(least, least_share(root, group, of_v2));
        else if (("," + controllers + ",").find("," + controller + ",") != std::string::npos)
            least = std::min(least, least_share(root / controllers, group, of_v1));
    }
    return least;
}

constexpr const char* kGroupsAreAt = "/sys/fs/cgroup";

std::string own_groups() {
    std::ifstream file("/proc/self/cgroup");
    std::ostringstream groups;
    groups << file.rdbuf();
    return groups.str();
}

}  // namespace

double granted_cores(const std::string& groups, const fs::path& root) {
    return least_share(groups, root, "cpu", share_of_v1, share_of_v2);
}

GroupLimits group_limits(const std::string& groups, const fs::path& root) {
    const Share threads = [](const fs::path& folder) { return number_in(folder / "pids.max"); };
    return {least_share(
                groups, root, "memory",
                [](const fs::path& folder) { return number_in(folder / "memory.limit_in_bytes"); },
                [](const fs::path& folder) { return number_in(folder / "memory.max"); }),
            least_share(groups, root, "pids", threads, threads)};
}

GroupLimits group_limits() {
    return group_limits(own_groups(), kGroupsAreAt);
}

int allotted_cores() {
    const double granted = std::ceil(granted_cores(own_groups(), kGroupsAreAt));
    return int(std::max(1.0, std::min(double(cores_of_affinity()), granted)));
}

namespace {

/// The first value of `name` in /proc/cpuinfo; "" if there is none.
std::string cpu_property(std::string_view name) {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with(name) && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "";
}

}  // namespace

std::string cpu_model() {
    const std::string model = cpu_property("model name");
    return model.empty() ? "unknown" : model;
}

std::string cpu_instructions() {
    utsname system{};
    uname(&system);
    std::string machine = system.machine;
    if (machine != "x86_64") return machine;
    // Mesa's own switch; it takes no notice of other values, and "avx" leaves FMA in.
    constexpr std::array<std::string_view, 6> kWithoutFma = {"nosse", "sse",   "sse2",
                                                             "sse3",  "ssse3", "sse4.1"};
    const char* limit = std::getenv("GALLIUM_OVERRIDE_CPU_CAPS");
    const bool limited = limit && std::ranges::find(kWithoutFma, limit) != kWithoutFma.end();
    const bool fma = (" " + cpu_property("flags") + " ").find(" fma ") != std::string::npos;
    return fma && !limited ? "x86-64 with FMA" : "x86-64 without FMA";
}

}  // namespace aftershade
