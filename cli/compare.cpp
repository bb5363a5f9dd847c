#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "cli/compare_options.h"
#include "cli/exit_code.h"
#include "cli/verbs.h"
#include "framework/base/atomic_file.h"
#include "framework/base/cores.h"
#include "framework/base/text.h"
#include "framework/compare/comparison_report.h"
#include "framework/compare/difference_picture.h"

namespace aftershade::cli {

namespace {

std::string title_of(const Comparison& comparison) {
    return comparison.reference.filename().string() + " | " + comparison.test.filename().string() + ": " +
           std::string(verdict_name(comparison.verdict));
}

void write_pictures(const CompareOptions& options, const ComparisonPictures& pictures,
                    const Comparison& comparison) {
    if (!options.output.empty()) pictures.write_difference(options.output);
    if (!options.heat_map.empty()) pictures.write_heat_map(options.heat_map);
    if (!options.side_by_side.empty())
        pictures.write_side_by_side(options.side_by_side, title_of(comparison));
}

/// Words that only the files can prove wrong.
void check_labels(const Comparison& comparison) {
    std::string text;
    const auto refuse = [&](const std::string& word, const std::vector<std::string>& labels) {
        for (const std::string& label : labels)
            text +=
                (text.empty() ? "" : "\n") + (word + label + ": error: neither file has this layer" +
                                              did_you_mean(label, comparison.labels) + " (the layers are " +
                                              list_of_names(comparison.labels, "and") + ")");
    };
    refuse("--role ", comparison.unknown_roles);
    refuse("--layer ", comparison.unknown_layers);
    if (!text.empty()) throw CodedError(kCompareUsage, text);
}

Verdict compare(const CompareOptions& options, const CompareRules& rules) {
    ComparisonPictures pictures({options.absolute, options.scale}, !options.output.empty(),
                                !options.heat_map.empty(), !options.side_by_side.empty());
    set_exr_threads(allotted_cores());
    const Comparison comparison = compare_files(
        options.reference, options.test, rules,
        [&](const LayerComparison& layer, LayerImages& images) { pictures.add(layer, images); });
    check_labels(comparison);
    std::ostream& for_people = options.json ? std::cerr : std::cout;
    if (comparison.verdict == Verdict::file_error && !options.json)
        for (const std::string& fault : comparison.faults)
            std::cerr << "aftershade: error: " << printable(fault) << "\n";
    else if (!options.quiet) for_people << text_of(comparison, rules) << std::flush;
    if (options.json) std::cout << json_text(comparison, rules) << std::flush;
    if (!options.csv.empty()) write_text_file(options.csv, csv_header() + csv_rows(comparison));
    const bool draw = comparison.verdict != Verdict::same || !options.only_different;
    if (draw && comparison.verdict != Verdict::file_error) write_pictures(options, pictures, comparison);
    return comparison.verdict;
}

/// An error of the machine under idiff's codes.
Verdict file_error(const char* message) {
    std::cerr << "aftershade: error: " << printable(message) << "\n";
    return Verdict::file_error;
}

ExitCode run(const CompareOptions& options) {
    Verdict verdict = Verdict::file_error;
    try {
        verdict = compare(options, rules_of(options));
    } catch (const CodedError&) {
        throw;
    } catch (const Error& error) {
        verdict = file_error(error.what());
    } catch (const std::bad_alloc&) {
        verdict = file_error("out of memory");
    }
    return ExitCode(int(verdict));
}

}  // namespace

Verb add_compare(CLI::App& app) {
    auto options = std::make_shared<CompareOptions>();
    add_compare_options(app, *options);
    return [options] { return run(*options); };
}

}  // namespace aftershade::cli
