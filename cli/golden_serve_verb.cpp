#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "cli/compare_options.h"
#include "cli/golden_options.h"
#include "cli/interrupt.h"
#include "framework/base/error.h"
#include "framework/base/path_bounds.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/golden/golden_apply.h"
#include "framework/golden/report_page.h"
#include "framework/review/review_server.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ReviewArguments {
    GoldenOptions golden;  ///< `suite` is a suite or a report
    int port = 0;
};

bool holds_report(const fs::path& folder) {
    std::error_code failure;
    return fs::exists(folder / "report.json", failure);
}

/// The suite that a report names. One from elsewhere could name any on this machine.
std::string suite_of(const fs::path& report) {
    std::string suite;
    with_report(report, [&](Json& data) { suite = data.at("document").get<std::string>(); });
    const std::string why = out_of_bounds(suite, fs::current_path());
    std::error_code failure;
    if (why.empty() && fs::is_regular_file(suite, failure)) {
        const fs::path document(suite);  // as the user most likely named it, for the commands in sidecars
        return fs::proximate(document.filename() == "golden.json" ? document.parent_path() : document)
            .string();
    }
    throw CodedError(kCompareUsage,
                     report.string() + ": its suite '" + suite +
                         "' is not in this folder; name yours: aftershade golden serve SUITE --report " +
                         report.string());
}

/// The suite and the report that the words name. Runs the suite where there is no report yet.
GoldenOptions with_report_of(GoldenOptions options) {
    if (holds_report(options.suite)) {
        options.report = options.suite;
        options.suite = suite_of(options.report);
    } else if (!holds_report(options.report)) {
        run_golden(options);
    }
    return options;
}

/// The bytes of the new image that a report shows, by case and image.
auto seen_bytes_of(const fs::path& report) {
    std::map<std::pair<std::string, std::string>, std::string> files;
    with_report(report, [&](Json& data) {
        for (const Json& test : data.at("cases"))
            for (const Json& image : test.at("images"))
                if (const Json& file = image.at("pictures").at("test_exr"); file.is_string())
                    files[{test.at("name").get<std::string>(), image.at("name").get<std::string>()}] = file;
    });
    return [report, files](const std::string& test, const std::string& name) {
        const auto found = files.find({test, name});
        const std::string file = found == files.end() ? "" : found->second;
        std::string fault;
        std::string bytes = read_file_below(report, file, std::uintmax_t(1) << 30, fault);
        if (!fault.empty()) throw Error(ErrorKind::capture, (report / file).string() + ": " + fault);
        return bytes;
    };
}

fs::path suite_folder_of(const GoldenOptions& options) {
    return fs::is_directory(options.suite) ? fs::path(options.suite)
                                           : fs::absolute(options.suite).parent_path();
}

GoldenApplied write_approved(const GoldenOptions& options, const std::vector<GoldenDecision>& decisions,
                             const std::function<void(int, int)>& drawn) {
    GoldenOptions drawing = options;
    drawing.report.clear();
    const GoldenSetup setup = prepare_golden(drawing);
    Diagnostics diagnostics;
    GoldenApplyOptions apply;
    apply.approvers = approvers_of(setup.suite.folder());
    const auto resolved = resolve_decisions(setup.suite, decisions, apply.approvers, diagnostics);
    if (diagnostics.has_errors()) throw CodedError(kCompareUsage, diagnostics);
    apply.any_renderer = options.any_renderer;
    apply.approve = approve_options_of(setup, drawing, approve_command(setup));
    apply.seen_bytes = seen_bytes_of(options.report);
    return apply_decisions(
        setup.suite, resolved, apply, [&](const GoldenCaseResult&, int done, int all) { drawn(done, all); },
        watch_for_interrupt());
}

ExitCode review_suite(const ReviewArguments& arguments) {
    const std::atomic<bool>& stop = watch_for_interrupt();
    const GoldenOptions options = with_report_of(arguments.golden);
    if (stop) return ExitCode::interrupted;
    review::ReviewSetup setup;
    setup.report = options.report;
    setup.suite = options.suite;
    setup.reviewer = approver_of(options, suite_folder_of(options));
    setup.page.limit_bytes = std::uint64_t(options.page_limit_mb * 1024 * 1024);
    setup.write = [&](const std::vector<GoldenDecision>& decisions,
                      const std::function<void(int, int)>& drawn) {
        return write_approved(options, decisions, drawn);
    };
    const std::string reviewer = setup.reviewer;
    review::serve_review(
        std::move(setup), arguments.port,
        [&](const std::string& address) {
            std::cout << address << std::endl;
            std::cerr << "the page is at the address above, for this machine alone; you "
                         "decide as '"
                      << printable(reviewer) << "'; interrupt to end\n";
        },
        stop);
    return ExitCode::interrupted;
}

}  // namespace

std::function<ExitCode()> add_golden_serve(CLI::App& golden) {
    auto arguments = std::make_shared<ReviewArguments>();
    arguments->golden.report = "report";
    auto* const verb = golden.add_subcommand(
        "serve", "Review a report in the browser: approve, reject, and write the approved images");
    verb->add_option("suite", arguments->golden.suite,
                     "A report's folder, or a suite: its report is that of --report")
        ->required();
    verb->add_option("--report", arguments->golden.report,
                     "The suite's report; without a report.json there the suite runs first")
        ->capture_default_str();
    verb->add_option("--port", arguments->port, "Port of 127.0.0.1; 0 takes a free one")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    add_page_limit(*verb, arguments->golden);
    add_approver_option(*verb, arguments->golden);
    add_any_renderer_option(*verb, arguments->golden);
    add_golden_drawing_options(*verb, arguments->golden);
    return [arguments] { return review_suite(*arguments); };
}

}  // namespace aftershade::cli
