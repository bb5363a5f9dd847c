#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/golden_options.h"
#include "cli/interrupt.h"
#include "framework/base/text.h"
#include "framework/golden/golden_explain.h"

namespace aftershade::cli {

namespace {

ExitCode explain(const GoldenOptions& options) {
    const std::atomic<bool>& stop = watch_for_interrupt();
    const GoldenSetup setup = prepare_golden(options);
    std::vector<const GoldenCase*> cases;
    for (const GoldenCase& test : setup.suite.cases)
        if (fits_filter(test, options.filters)) cases.push_back(&test);
    std::vector<GoldenExplanation> explanations(cases.size());
    for_each_in_folders(
        cases.size(), setup.context.options.jobs, [&](std::size_t i, const std::filesystem::path& work) {
            if (!stop)
                explanations[i] =
                    explain_case(*cases[i], setup.context.options, setup.suite.folder(), work, stop);
        });
    if (stop) return ExitCode::interrupted;
    for (std::size_t i = 0; i < cases.size(); ++i)
        std::cout << printable_lines(text_of(*cases[i], explanations[i]));
    const bool explained = std::ranges::all_of(explanations, &GoldenExplanation::is_explained);
    return explained ? ExitCode::done : ExitCode(int(Verdict::warning));
}

}  // namespace

std::function<ExitCode()> add_golden_explain(CLI::App& golden) {
    auto options = std::make_shared<GoldenOptions>();
    options->filter_place = "case ";
    auto* const verb = golden.add_subcommand(
        "explain", "Print the first step of a case that differs, what of it has changed, and the commits");
    verb->add_option("suite", options->suite, "A golden.json or its folder")->required();
    verb->add_option("case", options->filters, "Names of cases, globs or tags")->required();
    add_golden_drawing_options(*verb, *options);
    return [options] { return explain(*options); };
}

}  // namespace aftershade::cli
