#include "cli/golden_options.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/compare_options.h"
#include "cli/effect_options.h"
#include "cli/exit_code.h"
#include "cli/gl_options.h"
#include "cli/interrupt.h"
#include "framework/base/text.h"
#include "framework/golden/golden_commits.h"

namespace aftershade::cli {

namespace fs = std::filesystem;

namespace {

/// The options of the `part`-th case.
gpu::GlChoice gl_of(const GoldenOptions& options, int part) {
    GlOptions gl = options.gl;
    const char* environment = std::getenv("AFTERSHADE_BACKEND");
    // Goldens are made on software GL unless someone says otherwise, not on the GPU that is at hand.
    if (gl.backend.empty() && !(environment && *environment)) gl.backend = "software";
    try {
        return chosen_gl(gl, part);
    } catch (const Error& error) {
        throw CodedError(kCompareUsage, error.what());
    }
}

void check_words(const GoldenOptions& options, const GoldenSuite& suite, Diagnostics& diagnostics) {
    for (const std::string& path : options.effect_paths)
        if (!fs::is_directory(path)) diagnostics.error({"--effect-path " + path}, "no such folder");
    for (const std::string& filter : options.filters)
        if (std::ranges::none_of(suite.cases, [&](const auto& test) { return fits_filter(test, {filter}); }))
            diagnostics.error({options.filter_place + filter}, no_case_fits(suite, filter));
    if (!options.report.empty() && fs::exists(options.report) && !fs::is_directory(options.report))
        diagnostics.error({"--report " + options.report}, "is not a folder");
}

}  // namespace

void add_shared_golden_options(CLI::App& app, GoldenOptions& options) {
    app.add_option("suite", options.suite, "A golden.json or its folder")->required();
    app.add_option("--filter", options.filters,
                   "Only cases whose name matches this glob or that have this tag; repeatable")
        ->allow_extra_args(false);
    add_golden_drawing_options(app, options);
}

void add_golden_drawing_options(CLI::App& app, GoldenOptions& options) {
    app.add_option("-j,--jobs", options.jobs, "Cases to render at a time (default: one per core)")
        ->check(CLI::Range(0, 1024));
    app.add_option("--timeout", options.timeout_s, "Time limit per case, in seconds")
        ->check(CLI::Range(0.1, 1e6))
        ->capture_default_str();
    app.add_option("--effect-path", options.effect_paths,
                   "Search this folder for effects before the suite's and the shipped ones; repeatable")
        ->allow_extra_args(false);
    add_allow_path_option(app);
    app.add_option("--plugin-path", options.plugin_paths,
                   "Search this folder for native plug-ins; repeatable")
        ->allow_extra_args(false);
    add_gl_options(app, options.gl, "software");
}

GoldenSetup prepare_golden(const GoldenOptions& options) {
    Diagnostics diagnostics;
    GoldenSetup setup;
    std::optional<GoldenSuite> suite = read_golden_suite(options.suite, diagnostics);
    check_words(options, suite.value_or(GoldenSuite{}), diagnostics);
    if (!suite || diagnostics.has_errors()) throw CodedError(kCompareUsage, diagnostics);
    setup.suite = std::move(*suite);
    const gpu::GlChoice gl = gl_of(options, 0);

    GoldenRunOptions& run = setup.context.options;
    const int cores = std::max(1, int(std::thread::hardware_concurrency()));
    run.jobs = options.jobs > 0 ? options.jobs : cores;
    run.filters = options.filters;
    run.no_skip = options.no_skip;
    run.runs = options.repeat;
    run.program = AFTERSHADE_VERSION;
    run.report = options.report;
    run.render.timeout = std::chrono::milliseconds(std::int64_t(options.timeout_s * 1000));
    run.render.threads = std::max(1, cores / run.jobs);
    run.render.plugin_paths = options.plugin_paths;
    run.render.effect_paths = options.effect_paths;
    for (const fs::path& path : setup.suite.effect_paths) run.render.effect_paths.push_back(path.string());
    {
        const gpu::Context context(gl);
        warn_of_software(context.info());
        run.environment = environment_of(context.info());
        run.render.backend = gpu::backend_name(context.info().backend);
        run.render.device = [options, part = std::make_shared<std::atomic<int>>(0)] {
            return gl_of(options, (*part)++).device;
        };
    }

    std::vector<std::string> same;
    for (const std::string& path : options.effect_paths) same.insert(same.end(), {"--effect-path", path});
    for (const std::string& path : options.plugin_paths) same.insert(same.end(), {"--plugin-path", path});
    for (const auto& [name, value] :
         {std::pair{"--backend", options.gl.backend}, {"--device", options.gl.device}})
        if (!value.empty()) same.insert(same.end(), {name, value});
    setup.context.with_options = same.empty() ? "" : " " + printed_command(same);
    FetchedGoldens fetched =
        fetch_goldens(setup.suite, options.filters, run.render.timeout, watch_for_interrupt());
    run.unfetched = std::move(fetched.unfetched);
    if (!fetched.cache_fault.empty())
        std::cerr << "aftershade: warning: " << printable(fetched.cache_fault) << "\n";
    setup.context.commit = line_of_git(setup.suite.folder(), {"rev-parse", "HEAD"});
    return setup;
}

GoldenApproveOptions approve_options_of(const GoldenSetup& setup, const GoldenOptions& options,
                                        std::string command) {
    GoldenApproveOptions approve;
    approve.run = setup.context.options;
    approve.command = std::move(command);
    approve.approver = approver_of(options, setup.suite.folder());
    approve.approved = day_of_today();
    return approve;
}

std::string line_of_git(const fs::path& folder, const std::vector<std::string>& words) {
    const std::vector<std::string> lines = lines_of_git(folder, words);
    return lines.empty() ? "" : lines.back();
}

namespace {

fs::path approvers_file(const fs::path& folder) {
    return folder / "approvers.json";
}

/// A link that leads nowhere is a list that cannot be read, not an absent one.
bool has_approvers(const fs::path& folder) {
    return fs::exists(fs::symlink_status(approvers_file(folder)));
}

}  // namespace

std::optional<GoldenApprovers> approvers_of(const fs::path& folder) {
    if (!has_approvers(folder)) return std::nullopt;
    Diagnostics diagnostics;
    GoldenApprovers approvers = read_approvers(approvers_file(folder), diagnostics);
    if (diagnostics.has_errors()) throw CodedError(kCompareUsage, diagnostics);
    return approvers;
}

std::string approver_of(const GoldenOptions& options, const fs::path& folder) {
    std::string name = options.approver;
    if (name.empty()) {
        const char* const user = std::getenv("USER");
        name = line_of_git(folder, {"config", "user.name"});
        if (name.empty() && user) name = user;
        const std::string address =
            has_approvers(folder) ? line_of_git(folder, {"config", "user.email"}) : "";
        if (!address.empty()) name += (name.empty() ? "<" : " <") + address + ">";
    }
    if (const std::string fault = fault_of_name(name); !fault.empty())
        throw CodedError(kCompareUsage, "the approver's name " + fault +
                                            "; name yourself with --approver 'Ada <ada@example.org>'");
    return name;
}

std::string approve_command(const GoldenSetup& setup) {
    return printed_command({"aftershade", "golden", "approve", setup.suite.argument}) +
           setup.context.with_options;
}

void print_approval(const GoldenApproval& approval) {
    for (const GoldenCaseResult& test : approval.cases)
        if (test.verdict != Verdict::same) {
            const bool is_approved = test.verdict == Verdict::warning;
            std::cerr << fmt::format("\n{} {}: {}\n", is_approved ? "WARNING" : "FAILED", test.test->name,
                                     is_approved ? "approved" : "not approved, its goldens are as they were");
            for (const std::string& message : test.messages)
                std::cerr << "    " << printable_lines(message) << "\n";
        }
    std::cerr << "\n";
    for (const fs::path& path : approval.written) std::cout << path.string() << "\n";
    for (const fs::path& path : approval.renewed) std::cout << path.string() << "\n";
    std::cout << std::flush;
    for (const fs::path& path : approval.outdated)
        std::cerr << fmt::format(
            "{}: warning: approved too, by another renderer for another look or other effects; "
            "approve it again there, or remove it\n",
            path.string());
    std::cerr << fmt::format("{} written, {} renewed, {} unchanged\n",
                             counted(approval.written.size(), "image"),
                             counted(approval.renewed.size(), "sidecar"), approval.unchanged);
}

void add_approver_option(CLI::App& app, GoldenOptions& options) {
    app.add_option("--approver", options.approver,
                   "Name for the sidecars of new images (default: git's user.name, else $USER)")
        ->type_name("NAME");
}

void add_any_renderer_option(CLI::App& app, GoldenOptions& options) {
    app.add_flag(
        "--any-renderer", options.any_renderer,
        "Approve even if the goldens are from hardware and this renderer is software, or vice versa");
}

CLI::Option* add_page_limit(CLI::App& app, GoldenOptions& options) {
    return app
        .add_option("--page-limit", options.page_limit_mb,
                    "MiB of pictures to embed in index.html; it links to the rest")
        ->check(CLI::Range(0.0, 400.0))
        ->capture_default_str();
}

}  // namespace aftershade::cli
