#include "framework/look/pipeline.h"

#include <algorithm>
#include <type_traits>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/text.h"
#include "framework/capture/channel_names.h"
#include "framework/color/color_request.h"
#include "framework/document/param_type.h"
#include "framework/document/units.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

template <typename T>
bool contains(const std::vector<T>& list, const std::type_identity_t<T>& item) {
    return std::find(list.begin(), list.end(), item) != list.end();
}

template <typename T>
void add_once(std::vector<T>& list, const std::type_identity_t<T>& item) {
    if (!contains(list, item)) list.push_back(item);
}

std::string list_channels(const std::vector<std::string>& channels) {
    constexpr std::size_t kShown = 40;
    std::string text;
    for (std::size_t i = 0; i < std::min(channels.size(), kShown); ++i) text += (i ? ", " : "") + channels[i];
    if (channels.size() > kShown) text += " and " + std::to_string(channels.size() - kShown) + " more";
    return text;
}

/// Roles that the step's values, mix and mask are taken from.
std::vector<RoleId> host_roles(const PipelineStep& step) {
    std::vector<RoleId> roles = roles_of(step.mix);
    for (const auto& [name, value] : step.values)
        for (const RoleId& role : roles_of(value)) add_once(roles, role);
    if (step.mask && !step.mask->role.empty()) add_once(roles, step.mask->role);
    if (step.mask && !step.mask->objects.empty())
        add_once(roles, step.mask->names_objects() ? RoleId::coverage(step.mask->objects) : kObjectIdRole);
    return roles;
}

}  // namespace

bool PipelineStep::may_take(const InputSpec& input) const {
    return std::all_of(input.when.begin(), input.when.end(), [&](const WhenSpec& condition) {
        const auto value = values.find(condition.subject);
        const ParamSpec* spec = manifest->find_param(condition.subject);
        if (value == values.end() && !spec->from.empty()) return true;
        if (value != values.end() && !std::holds_alternative<ParamValue>(value->second)) return true;
        const ParamValue& known =
            value == values.end() ? spec->default_value : std::get<ParamValue>(value->second);
        return std::find(condition.values.begin(), condition.values.end(), known) != condition.values.end();
    });
}

std::vector<ParamValue> PipelineStep::known_values(const ParamSpec& spec) const {
    const auto asked = values.find(spec.name);
    if (asked == values.end()) return {with_file(spec, spec.default_value, manifest->folder)};
    if (const auto* literal = std::get_if<ParamValue>(&asked->second)) return {*literal};
    std::vector<ParamValue> known;
    if (const auto* keyed = std::get_if<KeyedValue>(&asked->second))
        for (const auto& [frame, key] : keyed->keys)
            if (const auto* literal = std::get_if<ParamValue>(&key.value)) known.push_back(*literal);
    return known;
}

std::vector<RoleId> Pipeline::capture_roles() const {
    std::vector<RoleId> roles{kColorRole};
    for (const PipelineStep& step : steps) {
        for (const InputSpec& input : step.manifest->inputs) {
            const InputSource& source = step.inputs.at(input.name);
            if (source.step < 0 && input.frame == 0 && step.may_take(input)) add_once(roles, source.output);
        }
        for (const auto& [output, source] : step.before)
            if (source.step < 0 && !source.output.empty()) add_once(roles, source.output);
        for (const RoleId& role : host_roles(step)) add_once(roles, role);
    }
    return roles;
}

std::vector<std::string> Pipeline::object_names() const {
    std::vector<std::string> names;
    const auto add = [&](const TableKey& key) {
        if (!key.name.empty()) add_once(names, key.name);
    };
    for (const PipelineStep& step : steps)
        for (const ParamSpec& spec : step.manifest->params)
            for (const ParamValue& value : step.known_values(spec))
                if (is_param_buffer(spec.type))
                    for (const auto& [key, row] : spec.type->table->rows(value).rows) add(key);
    return names;
}

std::vector<RoleId> Pipeline::neighbour_roles(int offset) const {
    std::vector<RoleId> roles;
    for (const PipelineStep& step : steps)
        for (const InputSpec& input : step.manifest->inputs)
            if (input.frame == offset && step.may_take(input))
                add_once(roles, step.inputs.at(input.name).output);
    return roles;
}

std::set<int> Pipeline::neighbour_offsets() const {
    std::set<int> offsets;
    for (const PipelineStep& step : steps)
        for (const InputSpec& input : step.manifest->inputs)
            if (input.frame != 0 && step.may_take(input)) offsets.insert(input.frame);
    return offsets;
}

const Capture* FrameInputs::at(int offset) const {
    if (offset == 0) return capture;
    const auto found = neighbours.find(offset);
    return found == neighbours.end() ? nullptr : found->second;
}

bool Pipeline::has_form_of(const Pipeline& other) const {
    const auto same_mask = [](const std::optional<MaskSpec>& one, const std::optional<MaskSpec>& two) {
        if (!one || !two) return !one && !two;
        return one->role == two->role && one->objects == two->objects && one->file == two->file &&
               one->invert == two->invert;
    };
    const auto same_step = [&](const PipelineStep& one, const PipelineStep& two) {
        const auto takes_same = [&](const InputSpec& input) {
            return one.may_take(input) == two.may_take(input);
        };
        return one.name == two.name && one.manifest == two.manifest && one.inputs == two.inputs &&
               one.before == two.before && same_mask(one.mask, two.mask) &&
               std::ranges::all_of(one.manifest->inputs, takes_same);
    };
    return taps == other.taps && std::ranges::equal(steps, other.steps, same_step);
}

bool Pipeline::writes_role(const std::string& role) const {
    for (const PipelineStep& step : steps)
        for (const OutputSpec& output : step.manifest->outputs)
            if (output.role == role) return true;
    return false;
}

bool Pipeline::has_history() const {
    return std::any_of(steps.begin(), steps.end(),
                       [](const PipelineStep& step) { return step.manifest->has_history(); });
}

bool Pipeline::has_foreign() const {
    return std::any_of(steps.begin(), steps.end(), [](const PipelineStep& step) { return step.is_foreign; });
}

int Pipeline::last_accumulating_step() const {
    for (int i = int(steps.size()) - 1; i >= 0; --i)
        if (steps[std::size_t(i)].manifest->accumulates_subframes) return i;
    return -1;
}

ParamValue with_file(const ParamSpec& spec, ParamValue value, const std::filesystem::path& folder) {
    if (!is_file_type(spec.type)) return value;
    auto& path = std::get<std::string>(value);
    if (!path.empty() && !is_config_address(path)) path = (folder / path).string();
    return value;
}

const ParamSpec& mix_spec() {
    static const ParamSpec spec = [] {
        ParamSpec mix;
        mix.name = "mix";
        mix.doc = "0: the image as it was before the step, 1: as the step made it.";
        mix.default_value = 1.0;
        mix.min = 0;
        mix.max = 1;
        return mix;
    }();
    return spec;
}

std::vector<MissingRole> find_missing_roles(const Pipeline& pipeline, const CaptureHeader& header) {
    const std::vector<std::string>& roles = header.roles;
    std::vector<MissingRole> missing;
    const auto add = [&](const std::string& who, const std::string& role, const std::string& instead = "") {
        if (std::ranges::find(missing, role, &MissingRole::role) == missing.end())
            missing.push_back({who, role, instead});
    };
    for (const PipelineStep& step : pipeline.steps) {
        const auto is_there = [&](const InputSource& source) {
            return source.step >= 0 || contains(roles, source.output) ||
                   contains(header.layer_roles, source.output);
        };
        for (const InputSpec& input : step.manifest->inputs) {
            const InputSource& source = step.inputs.at(input.name);
            const bool is_needed =
                input.instead.empty() ? !input.optional : !is_there(step.inputs.at(input.instead));
            if (is_needed && !is_there(source))
                add("step '" + step.name + "' (effect " + step.manifest->id + ")", source.output,
                    input.instead.empty() ? "" : step.inputs.at(input.instead).output);
        }
        for (const auto& [output, source] : step.before)
            if (source.step < 0 && !source.output.empty() && !contains(roles, source.output))
                add("the mix of step '" + step.name + "'", source.output);
        for (const RoleId& role : host_roles(step))
            if (!role.is_coverage() && !contains(roles, role.name()))
                add("a value or the mask of step '" + step.name + "'", role.name());
    }
    if (!contains(roles, kColorRole) && !pipeline.writes_role(kDisplayRole)) add("the output", kColorRole);
    return missing;
}

int PipelineStep::step_of_color() const {
    int last = -1;
    for (const InputSpec& input : manifest->inputs) {
        const auto source = inputs.find(input.name);
        if (input.role == kColorRole && source != inputs.end()) last = std::max(last, source->second.step);
    }
    return last;
}

std::vector<StaleLayers> find_stale_layers(const Pipeline& pipeline) {
    std::vector<StaleLayers> found;
    for (const PipelineStep& step : pipeline.steps) {
        if (std::ranges::none_of(step.manifest->inputs,
                                 [](const InputSpec& i) { return i.role == kColorRole && i.layer > 0; }))
            continue;
        std::vector<std::string> before;
        for (int i = 0; i <= step.step_of_color(); ++i) {
            const PipelineStep& earlier = pipeline.steps[std::size_t(i)];
            if (std::ranges::any_of(earlier.manifest->outputs,
                                    [](const OutputSpec& output) { return output.role == kColorRole; }))
                before.push_back(earlier.name);
        }
        if (!before.empty()) found.push_back({step.name, before});
    }
    return found;
}

namespace {

/// "profile blender or vray finds it; layer 'B' has it; role depth=FILE reads it from a file of its
/// own; ..."
std::string remedies(const std::string& role, const CaptureHeader& header, const CaptureReader* reader) {
    std::string text;
    if (const auto own = header.remedies.find(role); own != header.remedies.end()) text += own->second + "; ";
    if (reader) {
        const RoleElsewhere found = reader->find_elsewhere(header, role);
        if (!found.profiles.empty())
            text += spelled(Option::profile) + " " + joined(found.profiles, " or ") + " finds it; ";
        if (!found.layers.empty())
            text += spelled(Option::layer) + " " + list_of_names(found.layers) +
                    (found.layers.size() == 1 ? " has it; " : " have it; ");
    }
    if (kind_of_role(role) == RoleKind::display)
        text +=
            "a step before it that makes display, a view transform, gives it; of an ISF file \"space\": "
            "\"linear\" takes color; ";
    if (const auto half = header.half_there.find(role); half != header.half_there.end())
        text += half->second + "; ";
    if (kind_of_role(role) == RoleKind::motion)
        if (const auto motion = channels_of_motion(header.channels); !motion.empty())
            text += list_of_names(motion, "and") + (motion.size() == 1 ? " looks" : " look") +
                    " like motion, whose unit, direction and sign no name says, so it is read only as "
                    "declared; ";
    return text;
}

/// What helps whichever role is missing: a file of its own, or the names of its channels.
std::string general_remedies(const std::string& role) {
    return advice("", Option::role, role + "=FILE", " reads it from a file of its own; ") +
           "\"channels\": {\"" + role + "\": {\"channels\": [...]}} in capture.json names its channels";
}

}  // namespace

std::string need_of(const MissingRole& missing) {
    return missing.who + " needs the role '" + missing.role +
           (missing.instead.empty() ? "" : "' or '" + missing.instead) + "'";
}

Error missing_roles(const std::vector<MissingRole>& missing, const CaptureHeader& header,
                    const CaptureReader* reader) {
    std::vector<std::string> needs;
    std::string ways;
    for (const MissingRole& one : missing) {
        needs.push_back(need_of(one));
        const std::string own = remedies(one.role, header, reader);
        ways += missing.size() == 1 || own.empty() ? own : "for '" + one.role + "': " + own;
    }
    return Error(ErrorKind::capture,
                 header.path.string() + ": " + joined(needs, " and ") + ", which the profile '" +
                     header.profile + "' does not find among the channels " + list_channels(header.channels) +
                     (header.layer.empty() ? "" : ", in the layer '" + header.layer + "'") + " (" + ways +
                     general_remedies(missing.size() == 1 ? missing[0].role : "ROLE") + ")");
}

void require_capture_roles(const Pipeline& pipeline, const CaptureHeader& header,
                           const CaptureReader* reader) {
    if (const auto missing = find_missing_roles(pipeline, header); !missing.empty())
        throw missing_roles(missing, header, reader);
}

namespace {

std::string described(const ValueSource& source) {
    if (std::holds_alternative<KeyedValue>(source)) return ", by keys";
    if (const auto* camera = std::get_if<CameraValue>(&source)) return ", from camera." + camera->field;
    if (const auto* pixels = std::get_if<PixelValue>(&source))
        return pixels->measure == PixelValue::Measure::depth ? ", from depth" : ", from luminance";
    return "";
}

}  // namespace

ResolvedValue resolve_param(const PipelineStep& step, const ParamSpec& spec, const FrameInputs& frame) {
    const std::string label = step.name + "." + spec.name;
    if (const auto asked = step.values.find(spec.name); asked != step.values.end())
        return {evaluate(asked->second, spec, label, *frame.capture),
                step.origins.at(spec.name) + described(asked->second)};
    if (spec.from.starts_with(kFromCamera)) {
        const std::string field = spec.from.substr(kFromCamera.size());
        if (auto captured = camera_value(spec, field, label, frame.capture->header))
            return {std::move(*captured), frame.capture->header.camera.origin(field)};
    }
    return {with_file(spec, spec.default_value, step.manifest->folder), "the manifest"};
}

namespace {

/// A relation that the capture's or keyed values break; those of the look alone were checked before.
void require_relations(const PipelineStep& step, const ParamSet& params, const FrameInputs& frame) {
    for (const RelationFault& fault : check_relations(step.manifest->params, params))
        throw Error(ErrorKind::capture, frame.capture->header.path.string() + ": " +
                                            relation_message(step.name, fault) +
                                            " (set both in the look, or correct the capture's camera)");
}

}  // namespace

ParamSet resolve_params(const PipelineStep& step, const FrameInputs& frame) {
    ParamSet params;
    for (const ParamSpec& spec : step.manifest->params)
        params.set(spec.name, resolve_param(step, spec, frame).value);
    require_relations(step, params, frame);
    if (frame.scale != 1)
        for (const ParamSpec& spec : step.manifest->params)
            params.set(spec.name, scale_pixels(spec, params.get(spec.name), frame.scale));
    return params;
}

std::string explain_params(const Pipeline& pipeline, const FrameInputs& frame) {
    std::string text;
    for (const PipelineStep& step : pipeline.steps)
        for (const ParamSpec& spec : step.manifest->params) {
            const ResolvedValue resolved = resolve_param(step, spec, frame);
            const std::string unit = spec.unit.empty() ? "" : " " + spec.unit;
            text += step.name + "." + spec.name + " = " + format_value(spec, resolved.value) + unit + "   [" +
                    resolved.origin + "]\n";
        }
    return text;
}

}  // namespace aftershade
