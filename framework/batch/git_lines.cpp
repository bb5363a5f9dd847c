#include "framework/batch/git_lines.h"

#include <chrono>
#include <string_view>

#include "framework/base/error.h"
#include "framework/batch/worker.h"

namespace aftershade {

std::vector<std::string> lines_of_git(const std::filesystem::path& folder,
                                      const std::vector<std::string>& words) {
    WorkerCommand command;
    // A repository's own settings may name programs that a status starts.
    command.arguments = {"/usr/bin/git", "-c", "core.fsmonitor=false", "-C",
                         std::filesystem::absolute(folder).string()};
    command.arguments.insert(command.arguments.end(), words.begin(), words.end());
    command.limits.wall_time = std::chrono::seconds(10);
    std::vector<std::string> lines;
    WorkerListener listener;
    listener.on_stdout = [&](std::string_view line) { lines.emplace_back(line); };
    try {
        if (!run_worker(command, listener).succeeded()) lines.clear();
    } catch (const Error&) {
        return {};
    }
    return lines;
}

}  // namespace aftershade
