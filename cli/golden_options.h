// The words of `aftershade golden`, and its verbs that have a file of their own.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/cli11.h"
#include "cli/exit_code.h"
#include "cli/gl_options.h"
#include "framework/golden/golden_approve.h"
#include "framework/golden/golden_decisions.h"
#include "framework/golden/golden_report.h"

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

/// Who may approve images of the suite in the folder; nullopt where it has no approvers.json. Throws
/// CodedError(kCompareUsage) with every fault of the list.
std::optional<GoldenApprovers> approvers_of(const std::filesystem::path& folder);

/// --approver, else git's user.name in the folder, else $USER; "" where none of them is set. In a folder
/// with approvers.json, git's address follows git's name.
std::string approver_of(const GoldenOptions& options, const std::filesystem::path& folder);

/// `aftershade golden approve` of the suite, as its sidecars name it, whichever command approves.
std::string approve_command(const GoldenSetup& setup);

/// Cases that keep their goldens and sums on stderr, paths of new files on stdout.
void print_approval(const GoldenApproval& approval);

void add_approver_option(CLI::App& app, GoldenOptions& options);
void add_any_renderer_option(CLI::App& app, GoldenOptions& options);
CLI::Option* add_page_limit(CLI::App& app, GoldenOptions& options);

// Each adds a verb to `golden` and returns what runs when it is chosen.
std::function<ExitCode()> add_golden_apply(CLI::App& golden);    ///< approves by a file or by commits
std::function<ExitCode()> add_golden_comment(CLI::App& golden);  ///< prints a report for a pull request
std::function<ExitCode()> add_golden_explain(CLI::App& golden);  ///< says why a case differs
std::function<ExitCode()> add_golden_init(CLI::App& golden);     ///< writes a suite of one case
std::function<ExitCode()> add_golden_serve(CLI::App& golden);    ///< serves a page to review a report with

}  // namespace aftershade::cli
