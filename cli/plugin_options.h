// Untrusted code: --plugin-path, the limits of plug-ins and passes, and the process that a command with
// untrusted effects works in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/cli11.h"
#include "framework/base/error.h"
#include "framework/base/status.h"
#include "framework/batch/process_codes.h"
#include "framework/batch/watchdog.h"
#include "framework/effect/native/native_library.h"
#include "framework/effect/native/native_process.h"

namespace aftershade::cli {

struct PluginOptions {
    std::vector<std::string> paths;
    double timeout_s = 60;
    std::uint64_t memory_bytes = 4ull << 30;
    double pass_timeout_s = 60;
    bool limits_every_pass = false;  ///< --pass-timeout was given

    PassLimit pass_limit() const;
};

void add_plugin_options(CLI::App& app, PluginOptions& options);
/// --pass-timeout alone.
void add_pass_timeout_option(CLI::App& app, PluginOptions& options);

/// Runs this command once more as a worker, which writes to the same streams, where `is_foreign` says that it
/// uses untrusted code, or --plugin-path or --pass-timeout is given: a shader may crash or stop the GL
/// driver. Returns the exit code: the worker's, or 5 (7 for memory) with a message that names the pass.
/// nullopt: work in this process, which is the worker or needs none. Interrupts are watched for while it
/// runs.
std::optional<ExitCode> run_in_worker(const PluginOptions& options, bool is_foreign);

/// Memory that a worker with untrusted effects may use: three quarters of the machine's.
std::uint64_t foreign_memory_bytes();

/// Those of the process of plug-ins.
NativeProcessOptions native_process_options(const PluginOptions& options);

/// The linked libraries and those of the folders; the latter run in a process of their own, confined.
/// `status` must outlive the registry.
NativeRegistry native_registry(const PluginOptions& options, StatusWriter* status);

/// The command of that process; main() serves it.
inline constexpr const char* kNativeHostWord = "--native-host";

}  // namespace aftershade::cli
