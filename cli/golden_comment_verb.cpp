#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "cli/compare_options.h"
#include "cli/golden_options.h"
#include "framework/base/atomic_file.h"
#include "framework/base/input_files.h"
#include "framework/golden/golden_comment.h"

namespace aftershade::cli {

namespace {

struct CommentOptions {
    std::string report, output, sarif;
    bool annotations = false;
    GoldenCommentOptions comment;
};

void check_outputs(const CommentOptions& options) {
    InputFiles inputs;
    inputs.add(std::filesystem::path(options.report) / "report.json");
    Diagnostics diagnostics;
    for (const auto& [option, file] : {std::pair{"-o ", options.output}, {"--sarif ", options.sarif}})
        if (!file.empty()) inputs.check_output({option + file}, file, diagnostics);
    if (diagnostics.has_errors()) throw CodedError(kCompareUsage, diagnostics);
}

ExitCode comment(const CommentOptions& options) {
    check_outputs(options);
    const GoldenComment result = comment_on(options.report, options.comment);
    if (!options.output.empty()) write_text_file(options.output, result.markdown);
    if (!options.sarif.empty()) write_text_file(options.sarif, result.sarif);
    if (options.annotations) std::cout << result.annotations;
    else if (options.output.empty()) std::cout << result.markdown;
    return ExitCode::done;
}

}  // namespace

std::function<ExitCode()> add_golden_comment(CLI::App& golden) {
    auto options = std::make_shared<CommentOptions>();
    auto* const verb =
        golden.add_subcommand("comment", "Print a report as a comment for a pull request, in Markdown");
    verb->add_option("report", options->report, "The folder that run --report wrote")->required();
    verb->add_option("-o,--output", options->output, "Write the comment to this file instead");
    verb->add_option("--rows", options->comment.rows, "Most images in the table")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    verb->add_option("--report-url", options->comment.report_url, "Link to the report's page");
    verb->add_option(
        "--pictures-url", options->comment.pictures_url,
        "URL that serves the report's folder: write thumbnails.png there and show it in the comment");
    verb->add_flag("--annotations", options->annotations,
                   "Print GitHub's annotations, a line for each image that differs, instead of the comment");
    verb->add_option("--sarif", options->sarif, "Write the images that differ to this file, as SARIF 2.1.0");
    return [options] { return comment(*options); };
}

}  // namespace aftershade::cli
