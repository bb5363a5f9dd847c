// A look over a capture in this process: once, over what is stale, or again whenever a file of the look
// changes.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cli/bound_look.h"
#include "cli/run_arguments.h"
#include "cli/run_messages.h"
#include "framework/base/status.h"
#include "framework/batch/process_codes.h"
#include "framework/gpu/context.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"
#include "framework/run/run_frames.h"

namespace aftershade::cli {

/// Looks at times and sizes: editors replace files in more ways than notifications report alike, and a few
/// dozen files cost microseconds.
class FileWatch {
public:
    /// `paths` are files, and folders whose files count.
    explicit FileWatch(std::vector<std::filesystem::path> paths) : paths_(std::move(paths)), seen_(look()) {}

    /// Whether anything is other than at the last call.
    bool changed();
    const std::vector<std::filesystem::path>& paths() const { return paths_; }

private:
    struct State {
        std::filesystem::file_time_type time{};
        std::uintmax_t bytes = 0;
        bool operator==(const State&) const = default;
    };
    using States = std::map<std::filesystem::path, State>;
    States look() const;

    std::vector<std::filesystem::path> paths_;
    States seen_;
};

/// The look, the looks that it uses, and the folders of its effects, of modules and of shared shaders.
std::vector<std::filesystem::path> paths_to_watch(const Look& look, const Pipeline& pipeline,
                                                  const std::filesystem::path& data_folder);

/// A look with the state of its files from before they were read, so that no later save is missed.
struct WatchedLook {
    std::unique_ptr<BoundLook> bound;
    FileWatch files;
};
/// nullopt where binding fails; `diagnostics` says why.
std::optional<WatchedLook> bind_watched(const RunArguments& options, Diagnostics& diagnostics);

/// The work of `aftershade run`, for the commands that run a look too. Throws FaultyDocuments and Error.
ExitCode run(const RunArguments& options);

/// What stays as it is while a look is being worked on.
struct RunSession {
    const RunArguments& arguments;
    StatusWriter& status;
    Sequence& sequence;
    const CaptureReader& reader;
    std::function<gpu::Context&()> context;  ///< makes it at the first call
    std::function<void()> end_context;       ///< none: it is used again
    RunOptions run;
    OutputOptions outputs;
    ProgressStyle progress;
    std::vector<std::filesystem::path> profiles;  ///< documents of those that frames may be read by
};

/// Every frame of `run`, which is the session's or what is left of it; `current` are those that need no work.
ExitCode render(const RunSession& session, const RunOptions& run, const Pipeline& pipeline,
                const std::atomic<bool>& stop, const RunHooks& hooks = {},
                const std::vector<int>& current = {});
/// Leaves out what is current.
ExitCode render_stale(const RunSession& session, const BoundLook& bound, const std::atomic<bool>& stop);
/// Renders again whenever a file of the look changes, until it is interrupted. Faults are printed, and waited
/// out. The sequence takes the names of objects from each look.
ExitCode watch(const RunSession& session, WatchedLook look, const std::atomic<bool>& stop);

}  // namespace aftershade::cli
