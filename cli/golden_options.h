// The words of `aftershade golden`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/exit_code.h"
#include "cli/gl_options.h"
#include "framework/batch/golden_approve.h"
#include "framework/batch/golden_report.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

struct GoldenOptions {
    std::string suite;
    std::vector<std::string> filters, effect_paths, plugin_paths;
    std::string filter_place = "--filter ";  ///< where a filter stands, for messages
    GlOptions gl;
    int jobs = 0;  ///< 0: as many as there are cores
    double timeout_s = 600;
    // run
    bool json = false, no_skip = false;
    int repeat = 1;
    std::string junit, report;
    // approve
    bool any_renderer = false, add = false, renew_sidecars = false;
    std::string approver;  ///< "": git's user.name, else $USER
    // report
    std::string page;
    double page_limit_mb = 128;  ///< run too
};

void add_shared_golden_options(CLI::App& app, GoldenOptions& options);
/// Those of them that say how cases are drawn.
void add_golden_drawing_options(CLI::App& app, GoldenOptions& options);

/// The suite with its images fetched, what its workers will draw with, and what reports write about both.
/// Throws CodedError(kCompareUsage) with every fault of documents and words, Error(ErrorKind::gl) without a
/// usable backend.
struct GoldenSetup {
    GoldenSuite suite;
    GoldenReportContext context;
};
GoldenSetup prepare_golden(const GoldenOptions& options);

/// What approves the images of a suite now, by that command.
GoldenApproveOptions approve_options_of(const GoldenSetup& setup, const GoldenOptions& options,
                                        std::string command);

/// `aftershade golden run`.
ExitCode run_golden(const GoldenOptions& options);

/// The last line that `git -C folder` prints with these words; "" where git is absent or fails.
std::string line_of_git(const std::filesystem::path& folder, const std::vector<std::string>& words);

/// --approver, else git's user.name in the folder, else $USER; "" where none of them is set.
std::string approver_of(const GoldenOptions& options, const std::filesystem::path& folder);

}  // namespace aftershade::cli
