#include "framework/render/result_encodings.h"

#include <algorithm>
#include <optional>
#include <string>

#include "framework/effect/color_param.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

bool outputs(const PipelineStep& step, const std::string& role) {
    return std::ranges::find(step.manifest->outputs, role, &OutputSpec::role) != step.manifest->outputs.end();
}

bool takes(const PipelineStep& step, const std::string& role) {
    return std::ranges::find(step.manifest->inputs, role, &InputSpec::role) != step.manifest->inputs.end();
}

const ParamSpec* config_of(const PipelineStep& step) {
    const auto& params = step.manifest->params;
    const auto config = std::ranges::find(params, FileKind::ocio_config, &ParamSpec::file_kind);
    return config == params.end() ? nullptr : &*config;
}

/// Unknown where the step's file is not loaded.
ColorEncoding made_by(const StepFiles& files, int index, const ParamSpec& config) {
    const auto* transform = std::get_if<ColorTransform>(files.loaded(index, config.name));
    return transform ? transform->encoding : ColorTransform{}.encoding;
}

/// Whether the step's conversion is to a space, not back to the capture's primaries.
bool has_destination(const PipelineStep& step) {
    return std::ranges::any_of(step.manifest->params, [&](const ParamSpec& spec) {
        return spec.ocio == "destination" &&
               std::ranges::any_of(step.known_values(spec), [](const ParamValue& value) {
                   return !std::get<std::string>(value).empty();
               });
    });
}

}  // namespace

void set_encodings(const Pipeline& pipeline, const StepFiles& files, FrameResult& result) {
    for (int index = int(pipeline.steps.size()) - 1; index >= 0; --index) {
        const PipelineStep& step = pipeline.steps[std::size_t(index)];
        const ParamSpec* const config = config_of(step);
        if (!outputs(step, kDisplayRole) || (!config && takes(step, kDisplayRole))) continue;
        if (config) result.display_encoding = made_by(files, index, *config);
        break;
    }
    for (int index = int(pipeline.steps.size()) - 1; index >= 0; --index) {
        const PipelineStep& step = pipeline.steps[std::size_t(index)];
        const ParamSpec* const config = config_of(step);
        if (!config || !outputs(step, kColorRole)) continue;
        if (has_destination(step)) result.color_encoding = made_by(files, index, *config);
        break;
    }
}

}  // namespace aftershade
