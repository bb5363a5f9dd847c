#include "framework/batch/git_lines.h"

#include <chrono>
#include <string_view>

#include "framework/base/error.h"
#include "framework/batch/worker.h"

namespace aftershade {

std::vector<std::string> lines_of_git(const std::filesystem::path& folder,
                                      const std::vector<std::string>& words) {
    WorkerCommand command;
    // A repository's own settings may name programs that a status starts, and have signatures printed among
    // commits. A status that renews the index would run a hook.
    command.arguments = {"/usr/bin/git",
                         "--literal-pathspecs",
                         "--no-optional-locks",
                         "-c",
                         "core.fsmonitor=false",
                         "-c",
                         "log.showSignature=false",
                         "-C",
                         std::filesystem::absolute(folder).string()};
    // Of `git rev-parse --local-env-vars`, which hooks have, those that lead to another repository; and those
    // that contradict literal paths.
    command.without = {"GIT_DIR",
                       "GIT_WORK_TREE",
                       "GIT_IMPLICIT_WORK_TREE",
                       "GIT_COMMON_DIR",
                       "GIT_INDEX_FILE",
                       "GIT_OBJECT_DIRECTORY",
                       "GIT_ALTERNATE_OBJECT_DIRECTORIES",
                       "GIT_CONFIG",
                       "GIT_GRAFT_FILE",
                       "GIT_SHALLOW_FILE",
                       "GIT_REPLACE_REF_BASE",
                       "GIT_PREFIX",
                       "GIT_NAMESPACE",
                       "GIT_GLOB_PATHSPECS",
                       "GIT_NOGLOB_PATHSPECS",
                       "GIT_ICASE_PATHSPECS"};
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
