#include "framework/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>

#include "framework/core/error.h"
#include "framework/core/units.h"

namespace aftershade {

namespace {

bool contains(const std::vector<std::string>& list, const std::string& item) {
    return std::find(list.begin(), list.end(), item) != list.end();
}

std::string list_channels(const std::vector<std::string>& channels) {
    constexpr std::size_t kShown = 40;
    std::string text;
    for (std::size_t i = 0; i < std::min(channels.size(), kShown); ++i) text += (i ? ", " : "") + channels[i];
    if (channels.size() > kShown) text += " and " + std::to_string(channels.size() - kShown) + " more";
    return text;
}

/// The capture's number for a parameter that has a "from", in the parameter's unit.
std::optional<double> number_from_capture(const ParamSpec& spec, const std::string& field,
                                          const Camera& camera) {
    const auto value = camera.get(field);
    const std::string& unit = find_camera_field(field)->unit;
    if (!value || unit == spec.unit) return value;
    return convert_unit(*value, unit, spec.unit);
}

[[noreturn]] void refuse_value(const PipelineStep& step, const ParamSpec& spec, const std::string& value,
                               const CaptureHeader& header) {
    throw Error(ExitCode::capture, header.path.string() + ": " + spec.from + " is " + value +
                                       ", outside the range of " + step.name + "." + spec.name +
                                       " (set the parameter in the look, or mend the capture's camera)");
}

std::optional<ParamValue> value_from_capture(const PipelineStep& step, const ParamSpec& spec,
                                             const CaptureHeader& header) {
    constexpr std::string_view kCamera = "camera.";
    if (!spec.from.starts_with(kCamera)) return std::nullopt;
    if (spec.type == ParamType::enum_) {
        const std::string& name = header.camera.lens_model;
        if (name.empty()) return std::nullopt;
        if (!contains(spec.values, name)) refuse_value(step, spec, "'" + name + "'", header);
        return name;
    }
    const auto number = number_from_capture(spec, spec.from.substr(kCamera.size()), header.camera);
    if (!number) return std::nullopt;
    if ((spec.min && *number < *spec.min) || (spec.max && *number > *spec.max))
        refuse_value(step, spec, format_number(*number), header);
    if (spec.type == ParamType::int_) return std::int64_t(std::llround(*number));
    return *number;
}

}  // namespace

std::vector<std::string> Pipeline::capture_roles() const {
    std::vector<std::string> roles{"color"};
    for (const PipelineStep& step : steps)
        for (const auto& [input, source] : step.inputs)
            if (source.step < 0 && !contains(roles, source.output)) roles.push_back(source.output);
    return roles;
}

bool Pipeline::writes_role(const std::string& role) const {
    for (const PipelineStep& step : steps)
        for (const OutputSpec& output : step.manifest->outputs)
            if (output.role == role) return true;
    return false;
}

void require_capture_roles(const Pipeline& pipeline, const CaptureHeader& header) {
    const auto missing = [&](const std::string& who, const std::string& role) {
        throw Error(ExitCode::capture, header.path.string() + ": " + who + " needs the role '" + role +
                                           "', which the profile '" + header.profile +
                                           "' does not find among the channels " +
                                           list_channels(header.channels));
    };
    for (const PipelineStep& step : pipeline.steps)
        for (const InputSpec& input : step.manifest->inputs) {
            const InputSource& source = step.inputs.at(input.name);
            if (!input.optional && source.step < 0 && !contains(header.roles, source.output))
                missing("step '" + step.name + "' (effect " + step.manifest->id + ")", source.output);
        }
    if (!contains(header.roles, "color")) missing("the output", "color");
}

std::vector<std::string> present_inputs(const Pipeline& pipeline, int step,
                                        const std::vector<std::string>& capture_roles) {
    std::vector<std::string> present;
    for (const auto& [input, source] : pipeline.steps[std::size_t(step)].inputs)
        if (source.step >= 0 || contains(capture_roles, source.output)) present.push_back(input);
    return present;
}

namespace {

struct ResolvedValue {
    ParamValue value;
    std::string origin;
};

ResolvedValue resolve_param(const PipelineStep& step, const ParamSpec& spec, const CaptureHeader& header) {
    if (const auto asked = step.values.find(spec.name); asked != step.values.end())
        return {asked->second, step.origins.at(spec.name)};
    if (auto captured = value_from_capture(step, spec, header))
        return {std::move(*captured), header.camera.origin(spec.from.substr(spec.from.find('.') + 1))};
    return {spec.default_value, "the manifest"};
}

}  // namespace

ParamSet resolve_params(const PipelineStep& step, const CaptureHeader& header) {
    ParamSet params;
    for (const ParamSpec& spec : step.manifest->params)
        params.set(spec.name, resolve_param(step, spec, header).value);
    return params;
}

std::string explain_params(const Pipeline& pipeline, const CaptureHeader& header) {
    std::string text;
    for (const PipelineStep& step : pipeline.steps)
        for (const ParamSpec& spec : step.manifest->params) {
            const ResolvedValue resolved = resolve_param(step, spec, header);
            const std::string unit = spec.unit.empty() ? "" : " " + spec.unit;
            text += step.name + "." + spec.name + " = " + format_value(resolved.value) + unit + "   [" +
                    resolved.origin + "]\n";
        }
    return text;
}

}  // namespace aftershade
