#include "cli/bound_look.h"

#include <filesystem>
#include <string>

#include "cli/effect_options.h"
#include "framework/base/data_path.h"
#include "framework/look/look_content.h"
#include "framework/run/output.h"
#include "framework/run/run_state.h"

namespace aftershade::cli {

namespace {

std::optional<Look> look_of(const RunArguments& options, Diagnostics& diagnostics) {
    const LookVariables variables = look_variables(options, diagnostics);
    if (options.look_folder.empty()) return read_look(options.look, diagnostics, variables);
    std::optional<Node> node = read_document(options.look, diagnostics);
    if (!node) return std::nullopt;
    const std::filesystem::path name = std::filesystem::path(options.look).filename();
    node->place.file = (std::filesystem::path(options.look_folder) / name).string();
    return parse_look(*node, diagnostics, variables);
}

}  // namespace

std::unique_ptr<BoundLook> bind_look(const RunArguments& options, Diagnostics& diagnostics) {
    auto bound = std::make_unique<BoundLook>(find_effects(options.effect_paths, diagnostics));
    bound->look = look_of(options, diagnostics);
    PipelineOptions pipeline = options.pipeline;
    for (std::string& tap : pipeline.taps) tap = tap.substr(0, tap.find('='));  // the files are the output's
    if (bound->look) bound->pipeline = bind_pipeline(*bound->look, bound->effects, pipeline, diagnostics);
    return bound;
}

InputFiles run_inputs(const BoundLook& bound, const Sequence& sequence, const Diagnostics& faults) {
    InputFiles inputs;
    inputs.add(faults.documents());
    if (!faults.has_errors()) inputs.add(files_of_pipeline(bound.pipeline, data_path() / "glsl"));
    inputs.add(files_of_sequence(sequence));
    return inputs;
}

bool check_run_outputs(const RunArguments& options, const OutputOptions& outputs, const Sequence& sequence,
                       InputFiles& inputs, Diagnostics& diagnostics) {
    const auto check = [&](const std::string& word, const std::string& file) {
        return inputs.check_output({word + " " + file}, file, diagnostics);
    };
    check("--history-out", options.history_out);
    inputs.add(std::filesystem::path(options.history_in));
    check_outputs(outputs, sequence, inputs, diagnostics);
    check("--graph", options.graph);
    check("--telemetry-plot", options.telemetry_plot);
    check("--trace", options.trace);
    const bool may_report = check("--report", options.jobs.report);
    for (const std::string& pattern : outputs.patterns)
        if (const auto input = inputs.replaced_by(run_state(pattern).journal()))
            diagnostics.error({"-o " + pattern}, "the journal beside it would replace the input " +
                                                     input->string() + " (--no-journal does without)");
    return may_report;
}

}  // namespace aftershade::cli
