#include "framework/gpu/rasterizer_threads.h"

#include <charconv>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <sched.h>

namespace aftershade::gpu {
namespace {

/// "llvmpipe-3" has the number 3.
std::optional<std::size_t> number_of(std::string_view name) {
    constexpr std::string_view kPrefix = "llvmpipe-";
    if (!name.starts_with(kPrefix)) return std::nullopt;
    name.remove_prefix(kPrefix.size());
    std::size_t number = 0;
    const auto [end, fault] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (fault != std::errc() || end != name.data() + name.size()) return std::nullopt;
    return number;
}

/// Of this process, by its affinity mask.
std::vector<int> allowed_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    std::vector<int> cores;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return cores;
    for (int core = 0; core < CPU_SETSIZE; ++core)
        if (CPU_ISSET(core, &set)) cores.push_back(core);
    return cores;
}

}  // namespace

std::vector<std::optional<int>> cores_of_threads(const std::vector<std::string>& names,
                                                 const std::vector<int>& cores) {
    std::vector<std::optional<int>> result(names.size());
    std::vector<bool> is_taken(cores.size());
    std::size_t threads = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::optional<std::size_t> number = number_of(names[i]);
        if (!number) continue;
        if (*number >= cores.size() || is_taken[*number])
            return std::vector<std::optional<int>>(names.size());
        is_taken[*number] = true;
        result[i] = cores[*number];
        ++threads;
    }
    if (threads < 2 || threads < cores.size()) result.assign(names.size(), std::nullopt);
    return result;
}

void spread_rasterizer_threads() noexcept {
    try {
        const std::vector<int> cores = allowed_cores();
        if (cores.size() < 2) return;
        std::vector<int> ids;
        std::vector<std::string> names;
        for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
            std::ifstream file(task.path() / "comm");
            std::string name;
            if (!std::getline(file, name)) continue;
            ids.push_back(std::stoi(task.path().filename().string()));
            names.push_back(name);
        }
        const auto chosen = cores_of_threads(names, cores);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            if (!chosen[i]) continue;
            cpu_set_t set;
            CPU_ZERO(&set);
            CPU_SET(*chosen[i], &set);
            static_cast<void>(sched_setaffinity(ids[i], sizeof set, &set));
        }
    } catch (const std::exception&) {
        // No /proc: the system places them as it likes.
    }
}

}  // namespace aftershade::gpu
