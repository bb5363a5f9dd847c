#include "cli/bound_look.h"

#include <filesystem>

#include "cli/effect_options.h"

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

}  // namespace aftershade::cli
