#include "framework/gpu/thread_placement.h"

#include <sched.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace aftershade::gpu {

namespace fs = std::filesystem;

namespace {

std::vector<int> cores_of_process() {
    cpu_set_t set;
    CPU_ZERO(&set);
    std::vector<int> cores;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return cores;
    for (int core = 0; core < CPU_SETSIZE; ++core)
        if (CPU_ISSET(core, &set)) cores.push_back(core);
    return cores;
}

std::multimap<int, pid_t> software_threads() {
    const std::string_view prefix = "llvmpipe-";
    std::multimap<int, pid_t> threads;
    std::error_code error;
    for (const fs::directory_entry& task : fs::directory_iterator("/proc/self/task", error)) {
        std::string name;
        std::getline(std::ifstream(task.path() / "comm"), name);
        if (!name.starts_with(prefix)) continue;
        const std::string id = task.path().filename();
        int number = 0;
        pid_t thread = 0;
        if (std::from_chars(name.data() + prefix.size(), name.data() + name.size(), number).ec ==
                std::errc() &&
            std::from_chars(id.data(), id.data() + id.size(), thread).ec == std::errc())
            threads.emplace(number, thread);
    }
    return threads;
}

}  // namespace

std::vector<std::pair<pid_t, int>> placements(const std::multimap<int, pid_t>& threads,
                                              const std::vector<int>& cores) {
    if (cores.size() < 2 || threads.empty() || std::size_t(threads.rbegin()->first) + 1 != cores.size())
        return {};
    std::vector<std::pair<pid_t, int>> placed;
    for (const auto& [number, thread] : threads) placed.emplace_back(thread, cores[std::size_t(number)]);
    return placed;
}

void spread_software_threads() {
    for (const auto& [thread, core] : placements(software_threads(), cores_of_process())) {
        cpu_set_t set;
        CPU_ZERO(&set);
        CPU_SET(core, &set);
        sched_setaffinity(thread, sizeof set, &set);  // where it is refused the thread runs as before
    }
}

}  // namespace aftershade::gpu
