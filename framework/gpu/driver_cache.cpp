#include "framework/gpu/driver_cache.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace aftershade::gpu {
namespace {

bool some_thread_writes() {
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream file(task.path() / "stat");
        std::string stat;
        if (std::getline(file, stat) && is_writing_driver_cache(stat)) return true;
    }
    return false;
}

}  // namespace

bool is_writing_driver_cache(std::string_view stat) {
    // The name may hold brackets itself; the state follows the last one.
    const std::size_t end = stat.rfind(')');
    if (end == std::string_view::npos || end + 2 >= stat.size()) return false;
    const char state = stat[end + 2];
    return stat.substr(0, end).find(":disk$") != std::string_view::npos && (state == 'R' || state == 'D');
}

void wait_for_driver_cache() noexcept {
    using namespace std::chrono_literals;
    try {
        for (int i = 0; i < 100 && some_thread_writes(); ++i) std::this_thread::sleep_for(500us);
    } catch (const std::exception&) {
        // No /proc.
    }
}

}  // namespace aftershade::gpu
