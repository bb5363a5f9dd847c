#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/compare_options.h"
#include "cli/exit_code.h"
#include "cli/golden_options.h"
#include "cli/interrupt.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/input_files.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/golden/golden_approve.h"
#include "framework/golden/report_page.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;

void print_head(const GoldenReportContext& context) {
    const GoldenEnvironment& environment = context.options.environment;
    std::cerr << fmt::format("{}: {}, {} at a time, {}: {}, {}, {}\n", printable(context.suite->argument),
                             counted(context.suite->cases.size(), "case"), context.options.jobs,
                             environment.backend, environment.renderer, environment.version, environment.cpu);
}

fs::path write_page(const fs::path& report, fs::path page, double limit_mb) {
    if (page.empty()) page = path_below(report, "index.html");
    write_report_page(report, page, {std::uint64_t(limit_mb * 1024 * 1024)});
    return page;
}

/// Whether a file is absent, or a report of an earlier run: an end before the outputs were held against the
/// inputs replaces nothing else.
bool may_replace(const fs::path& file, std::string_view begin) {
    std::error_code failure;
    return !fs::exists(file, failure) || file_begins_with(file, begin);
}

/// A run that does not end must not leave the figures of an earlier one beside its own pictures.
void remove_old_reports(const GoldenOptions& options) {
    std::error_code failure;
    if (!options.junit.empty() && fs::is_regular_file(options.junit, failure))
        fs::remove(options.junit, failure);
    if (options.report.empty()) return;
    if (!fs::remove(fs::path(options.report) / "report.json", failure)) return;
    fs::remove(fs::path(options.report) / "index.html", failure);
}

/// Reports of an earlier run would be taken for this one's. Faults of writing are not worth more than the
/// cause.
void write_early_end(const GoldenOptions& options, const std::string& message, int exit_code) {
    const GoldenEarlyEnd end{options.suite, message, exit_code};
    const auto warned = [](const auto& write) {
        try {
            write();
        } catch (const std::exception& error) {
            std::cerr << "aftershade: warning: " << error.what() << "\n";
        }
    };
    // First, since the file of --junit may lie in the folder of --report.
    warned([&] {
        const fs::path report(options.report), json = report / "report.json", page = report / "index.html";
        if (options.report.empty() || !may_replace(json, "{\n  \"aftershade\"") || !may_replace(page, "<!"))
            return;
        fs::create_directories(report);
        path_below(report, page.filename());
        path_below(report, json.filename());
        write_text_file(
            json, early_json_of(end).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
        write_text_file(page, early_page_of(end));
    });
    warned([&] {
        if (!options.junit.empty() && may_replace(options.junit, "<?xml"))
            write_text_file(options.junit, early_junit_of(end));
    });
}

/// The code that this verb ends with.
ExitCode own_code(const Error& error) {
    return error.kind() == ErrorKind::usage ? kCompareUsage : ExitCode(int(Verdict::file_error));
}

void write_reports(const GoldenOptions& options, const GoldenSuiteResult& result,
                   const GoldenReportContext& context) {
    if (!options.junit.empty()) write_text_file(options.junit, junit_of(result, context));
    if (!options.json && options.report.empty()) return;
    const std::string json =
        json_of(result, context).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (!options.report.empty()) {
        write_text_file(path_below(options.report, "report.json"), json);
        std::cerr << "report: " << write_page(options.report, "", options.page_limit_mb).string() << "\n";
    }
    if (options.json) std::fwrite(json.data(), 1, json.size(), stdout);
}

/// What the sums do not say: why a run that is not bad proves less than it seems to.
void print_notes(const GoldenSuiteResult& result) {
    if (result.all_skipped()) std::cerr << "warning: every case was skipped; nothing was compared\n";
    for (const GoldenCaseResult& test : result.cases)
        if (!test.test->quarantine.until.empty() && test.skipped.empty() && test.verdict == Verdict::same)
            std::cerr << fmt::format("note: {} passes; it needs no quarantine\n", test.test->name);
    std::vector<fs::path> bare;
    for (const GoldenCaseResult& test : result.cases)
        for (const GoldenImage& image : test.images)
            if (image.approved && !image.approved->sidecar && !image.approved->sidecar_fault)
                bare.push_back(image.approved->file);
    if (bare.empty()) return;
    std::cerr << fmt::format("note: {}{}: no sidecar records what made {}, so only the tolerance counts\n",
                             bare.front().string(),
                             bare.size() > 1 ? fmt::format(" and {} more goldens", bare.size() - 1) : "",
                             bare.size() > 1 ? "them" : "it");
}

/// Throws CodedError(kCompareUsage).
void refuse_outputs(const Diagnostics& diagnostics) {
    std::string text;
    for (const Diagnostic& fault : diagnostics.all())
        text += (text.empty() ? "" : "\n") + to_string(fault.place) + ": error: " + fault.message;
    if (!text.empty()) throw CodedError(kCompareUsage, text);
}

void check_outputs(const GoldenOptions& options, const GoldenSuite& suite) {
    if (options.junit.empty() && options.report.empty()) return;
    InputFiles inputs = suite_inputs(suite, true);
    Diagnostics diagnostics;
    inputs.check_output({"--junit " + options.junit}, options.junit, diagnostics);
    if (!options.report.empty())
        for (const char* name : {"index.html", "report.json"})
            inputs.check_output({"--report " + options.report}, fs::path(options.report) / name, diagnostics);
    refuse_outputs(diagnostics);
}

ExitCode run_prepared(const GoldenOptions& options, const GoldenSetup& setup) {
    const std::atomic<bool>& stop = watch_for_interrupt();
    remove_old_reports(options);
    if (!options.report.empty()) {
        std::error_code failure;
        fs::create_directories(options.report, failure);
        if (failure) throw Error(ErrorKind::output, "--report " + options.report + ": " + failure.message());
    }
    print_head(setup.context);
    const GoldenSuiteResult result = run_golden_suite(
        setup.suite, setup.context.options,
        [](const GoldenCaseResult& test, int done, int all) {
            std::cerr << printable_lines(line_of(test, done, all)) << "\n";
        },
        stop);
    std::cerr << printable_lines(summary_of(result, setup.context));
    if (result.interrupted) return ExitCode::interrupted;
    print_notes(result);
    write_reports(options, result, setup.context);
    return ExitCode(int(result.verdict));
}

}  // namespace

ExitCode run_golden(const GoldenOptions& options) {
    const auto or_early_end = [&](const auto& work) {
        try {
            return work();
        } catch (const Error& error) {
            write_early_end(options, error.what(), int(own_code(error)));
            throw;
        }
    };
    GoldenSetup setup = or_early_end([&] { return prepare_golden(options); });
    setup.context.suite = &setup.suite;
    check_outputs(options, setup.suite);
    return or_early_end([&] { return run_prepared(options, setup); });
}

namespace {

ExitCode approve(const GoldenOptions& options) {
    const std::atomic<bool>& stop = watch_for_interrupt();
    GoldenSetup setup = prepare_golden(options);
    setup.context.suite = &setup.suite;
    print_head(setup.context);
    if (!options.any_renderer)
        if (const std::string why = foreign_goldens(setup.suite, setup.context.options); !why.empty())
            throw CodedError(kCompareUsage, why);
    GoldenApproveOptions approve_options = approve_options_of(setup, options, approve_command(setup));
    approve_options.add = options.add;
    approve_options.renew_sidecars = options.renew_sidecars;
    if (const auto approvers = approvers_of(setup.suite.folder()))
        approve_options.why_not = [approvers, by = approve_options.approver](const GoldenCase& test,
                                                                             const auto&...) {
            return approvers->may(by, test.name)
                       ? std::string()
                       : fmt::format(
                             "'{}' may not approve it; approvers.json names who may (--approver says "
                             "who you are)",
                             by);
        };
    const GoldenApproval approval = approve_goldens(
        setup.suite, approve_options,
        [](const GoldenCaseResult& test, int done, int all) {
            std::cerr << printable_lines(line_of(test, done, all, "Drawn ")) << "\n";
        },
        stop);
    if (approval.interrupted) {
        std::cerr << "interrupted; nothing was written\n";
        return ExitCode::interrupted;
    }
    print_approval(approval);
    if (!approval.written.empty() && !approve_options.approver.empty())
        std::cerr << fmt::format("approved by {}, {}\n", approve_options.approver, approve_options.approved);
    return ExitCode(int(approval.verdict));
}

ExitCode report(const GoldenOptions& options) {
    InputFiles inputs;
    inputs.add(fs::path(options.report) / "report.json");
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(fs::path(options.report) / "images", absent))
        inputs.add(entry.path());
    Diagnostics diagnostics;
    inputs.check_output({"-o " + options.page}, options.page, diagnostics);
    refuse_outputs(diagnostics);
    std::cout << write_page(options.report, options.page, options.page_limit_mb).string() << "\n";
    return ExitCode::done;
}

/// The codes of this verb are idiff's: what cannot be read, drawn or written is a file error.
ExitCode with_own_codes(const std::function<ExitCode()>& work) {
    try {
        return work();
    } catch (const Error& error) {
        throw CodedError(own_code(error), error.what());
    } catch (const fs::filesystem_error& error) {
        throw CodedError(ExitCode(int(Verdict::file_error)), error.what());
    }
}

}  // namespace

Verb add_golden(CLI::App& app) {
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 same, 1 warning, 2 failure, 3 different size or channels, 4 a file cannot be read or "
        "written (or no GL), 64 wrong usage, 130 interrupted.");
    auto options = std::make_shared<GoldenOptions>();
    auto* run_verb = app.add_subcommand("run", "Render the cases and compare them with their goldens");
    add_shared_golden_options(*run_verb, *options);
    run_verb->add_flag("--no-skip", options->no_skip, "Treat skipped cases as failures");
    run_verb
        ->add_option("--repeat", options->repeat,
                     "Draw each case this many times; a case fails whose runs differ in bits, and names the "
                     "first pass that does")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    run_verb->add_option("--junit", options->junit, "Write JUnit XML to this file");
    run_verb->add_option("--report", options->report,
                         "Write a report (index.html, report.json, pictures) to this folder");
    add_page_limit(*run_verb, *options)->needs("--report");
    run_verb->add_flag("--json", options->json, "Print report.json on stdout");
    auto* approve_verb =
        app.add_subcommand("approve", "Render the cases, keep new results as goldens and print their paths");
    add_shared_golden_options(*approve_verb, *options);
    approve_verb->add_flag("--add", options->add,
                           "Add a golden for this renderer and keep those of other renderers");
    add_any_renderer_option(*approve_verb, *options);
    approve_verb->add_flag("--renew-sidecars", options->renew_sidecars,
                           "If the bits are equal, update the sidecar (renderer, hash of look and effects)");
    add_approver_option(*approve_verb, *options);
    auto* report_verb =
        app.add_subcommand("report", "Rebuild the page of a report folder and print its path");
    report_verb->add_option("report", options->report, "The folder that run --report wrote")->required();
    report_verb->add_option("-o,--output", options->page,
                            "Write the page here (default: index.html in that folder)");
    add_page_limit(*report_verb, *options);
    const std::map<std::string, std::function<ExitCode()>> others{{"comment", add_golden_comment(app)},
                                                                  {"init", add_golden_init(app)},
                                                                  {"explain", add_golden_explain(app)},
                                                                  {"serve", add_golden_serve(app)},
                                                                  {"apply-approvals", add_golden_apply(app)}};
    return [options, approve_verb, report_verb, others, &app] {
        return with_own_codes([&] {
            const auto other = others.find(app.get_subcommands().front()->get_name());
            if (other != others.end()) return other->second();
            if (report_verb->parsed()) return report(*options);
            return approve_verb->parsed() ? approve(*options) : run_golden(*options);
        });
    };
}

}  // namespace aftershade::cli
