#include <algorithm>
#include <utility>

#include "aftershade/effects.h"
#include "aftershade/look.h"
#include "framework/base/data_path.h"
#include "framework/host/host_data.h"
#include "framework/host/image_data.h"
#include "framework/host/look_data.h"
#include "framework/host/rendering.h"
#include "framework/image/role.h"

namespace aftershade::host {

namespace fs = std::filesystem;

namespace {

LookVariables variables_of(const LookOptions& options) {
    Diagnostics faults;
    LookVariables variables;
    for (const auto& [name, value] : options.variables)
        if (auto node = node_of(value, name, faults)) variables[name] = std::move(*node);
    stop_at_errors(ErrorKind::usage, faults);
    return variables;
}

std::shared_ptr<LookCore> load(Host::Data& host, const std::optional<Node>& document, Diagnostics& faults,
                               const LookOptions& options) {
    auto core = std::make_shared<LookCore>(host.registry());
    core->taps = options.taps;
    const LookVariables variables = variables_of(options);
    auto look = document ? parse_look(*document, faults, variables) : std::nullopt;
    if (look) {
        core->look = std::move(*look);
        // Faults of the document and of what it asks of effects come together.
        core->pipeline = bind_pipeline(core->look, core->effects, {{}, options.taps}, faults);
    }
    stop_at_errors(ErrorKind::document, faults);
    core->warnings = public_diagnostics(faults.all());
    core->documents = std::make_shared<const std::vector<fs::path>>(faults.documents());
    return core;
}

struct FoundParam {
    const PipelineStep* step;
    const ParamSpec* spec;
};

/// Of "step.param"; the host's mix too. Throws Error(usage).
FoundParam find_param(const LookCore& core, const std::string& name) {
    const std::size_t dot = name.find('.');
    std::vector<std::string> known;
    for (const PipelineStep& step : core.pipeline.steps) {
        for (const ParamSpec& spec : step.manifest->params) {
            if (dot != std::string::npos && step.name == name.substr(0, dot) &&
                spec.name == name.substr(dot + 1))
                return {&step, &spec};
            known.push_back(step.name + "." + spec.name);
        }
        if (name == step.name + "." + mix_spec().name) return {&step, &mix_spec()};
    }
    fail_at(ErrorKind::usage, name, "the look has no such parameter" + did_you_mean(name, known));
}

Value value_now(const FoundParam& param) {
    if (param.spec == &mix_spec()) return value_of(*param.spec, param.step->mix);
    const auto asked = param.step->values.find(param.spec->name);
    return asked != param.step->values.end() ? value_of(*param.spec, asked->second)
                                             : value_of(*param.spec, param.spec->default_value);
}

std::string origin_of(const PipelineStep& step, const ParamSpec& spec) {
    const auto asked = step.origins.find(spec.name);
    if (asked != step.origins.end()) return asked->second;
    return spec.from.empty() ? "the manifest" : "the capture's " + spec.from + ", else the manifest";
}

}  // namespace

void LookCore::bind(std::map<std::string, Node> values, ErrorKind kind) {
    PipelineOptions options{{}, taps};
    for (const auto& [name, value] : values) options.overrides.push_back({name, value});
    Diagnostics faults;
    Pipeline bound = bind_pipeline(look, effects, options, faults);
    stop_at_errors(kind, faults);
    if (!bound.has_form_of(pipeline)) ++form;
    ++revision;
    pipeline = std::move(bound);
    overrides = std::move(values);
}

Look Host::load_look(const fs::path& path, const LookOptions& options) {
    auto host = Access::share(*this);
    return called(*host, [&] {
        if (!options.folder.empty())
            fail_at(ErrorKind::usage, "LookOptions::folder",
                    "a look that is a file names files from its own");
        Diagnostics faults;
        const auto document = read_document(path, faults);
        auto data = std::make_shared<Look::Data>();
        data->core = load(*host, document, faults, options);
        data->host = host;
        return Access::make<Look>(std::move(data));
    });
}

Look Host::parse_look(std::string_view json, const LookOptions& options) {
    auto host = Access::share(*this);
    return called(*host, [&] {
        Diagnostics faults;
        const std::string name = (options.folder / options.name).string();
        const auto document = parse_document(json, name, faults);
        auto data = std::make_shared<Look::Data>();
        data->core = load(*host, document, faults, options);
        data->host = host;
        return Access::make<Look>(std::move(data));
    });
}

Look::Look(std::shared_ptr<Data> data) : data_(std::move(data)) {}
Look::Look(Look&&) noexcept = default;
Look& Look::operator=(Look&&) noexcept = default;
Look::~Look() = default;

namespace {

template <typename Data>
Data& required(const std::shared_ptr<Data>& data) {
    if (!data) fail(ErrorKind::usage, "this Look was moved from");
    return *data;
}

}  // namespace

std::vector<std::string> Look::steps() const {
    return called(*required(data_).host, [&] {
        std::vector<std::string> names;
        for (const PipelineStep& step : data_->core->pipeline.steps) names.push_back(step.name);
        return names;
    });
}

std::vector<LookParam> Look::params() const {
    return called(*required(data_).host, [&] {
        std::vector<LookParam> params;
        for (const PipelineStep& step : data_->core->pipeline.steps)
            for (const ParamSpec& spec : step.manifest->params)
                params.push_back({step.name + "." + spec.name, step.name, info_of(spec),
                                  value_now({&step, &spec}), origin_of(step, spec)});
        return params;
    });
}

std::vector<std::string> Look::inputs() const {
    return called(*required(data_).host, [&] {
        std::vector<std::string> names;
        for (const RoleId& role : data_->core->pipeline.capture_roles())
            if (!role.is_coverage()) names.push_back(role.name());
        return names;
    });
}

std::vector<std::string> Look::outputs() const {
    return called(*required(data_).host, [&] { return made_roles(data_->core->pipeline); });
}

bool Look::has_history() const {
    return called(*required(data_).host, [&] { return data_->core->pipeline.has_history(); });
}

std::vector<Diagnostic> Look::warnings() const {
    return called(*required(data_).host, [&] { return data_->core->warnings; });
}

void Look::set(const std::string& name, const Value& value) {
    set(std::map<std::string, Value>{{name, value}});
}

void Look::set(const std::map<std::string, Value>& values) {
    called(*required(data_).host, [&] {
        Diagnostics faults;
        auto nodes = data_->core->overrides;
        for (const auto& [name, value] : values)
            if (auto node = node_of(value, name, faults)) nodes[name] = std::move(*node);
        stop_at_errors(ErrorKind::usage, faults);
        data_->core->bind(std::move(nodes), ErrorKind::usage);
    });
}

void Look::reset(const std::string& name) {
    called(*required(data_).host, [&] {
        find_param(*data_->core, name);
        auto nodes = data_->core->overrides;
        if (nodes.erase(name) > 0) data_->core->bind(std::move(nodes), ErrorKind::usage);
    });
}

Value Look::get(const std::string& name) const {
    return called(*required(data_).host, [&] { return value_now(find_param(*data_->core, name)); });
}

Capture Look::read(const fs::path& path, const CaptureOptions& options) const {
    return called(*required(data_).host, [&] {
        const Pipeline& pipeline = data_->core->pipeline;
        const auto sequence = open_sequence_data(*data_->host, path, options, pipeline.object_names());
        const auto roles = options.roles.empty() ? pipeline.capture_roles() : role_ids(options.roles);
        return read_capture(*sequence, sequence->sequence.frames.front(), 0, roles);
    });
}

Result Look::render(const Capture& capture, const RenderOptions& options) {
    Data& data = required(data_);
    return called(*data.host, [&] {
        if (!data.rendering) data.rendering = std::make_unique<Rendering>(data.host, data.core);
        FrameTask task;
        task.capture = Access::share(capture);
        task.begins_shot = true;
        return Access::make<Result>(
            std::make_shared<const Result::Data>(data.rendering->render(task, options)));
    });
}

namespace {

std::vector<PresetInfo> presets_of(const EffectManifest& manifest) {
    std::vector<PresetInfo> presets;
    for (const PresetSpec& preset : manifest.presets) {
        PresetInfo info{preset.name, {}};
        for (const auto& [name, value] : preset.values)
            info.values.push_back({name, value_of(*manifest.find_param(name), value)});
        presets.push_back(std::move(info));
    }
    return presets;
}

EffectInfo info_of(const EffectManifest& manifest) {
    EffectInfo info;
    info.id = manifest.id;
    info.version = manifest.version;
    info.summary = manifest.summary;
    info.folder = manifest.folder.string();
    for (const InputSpec& input : manifest.inputs)
        info.inputs.push_back(
            {input.name, input.image_role(), input.doc, input.optional, input.history, input.frame});
    for (const OutputSpec& output : manifest.outputs)
        info.outputs.push_back({output.name, output.role, output.doc});
    for (const ParamSpec& spec : manifest.params) info.params.push_back(host::info_of(spec));
    for (const TextureSpec& texture : manifest.textures)
        if (texture.layers == 1) info.textures.push_back(texture.name);
    info.presets = presets_of(manifest);
    info.sources = manifest.sources;
    info.has_history = manifest.has_history();
    info.has_native_code = manifest.native.has_value();
    info.warmup_frames = manifest.warmup ? manifest.warmup->frames : 0;
    return info;
}

}  // namespace

std::vector<EffectInfo> Host::effects(std::vector<Diagnostic>* faults) const {
    Data& data = Access::host(*this);
    return called(data, [&] {
        EffectRegistry registry = data.registry();
        Diagnostics found;
        registry.warn_of_unreadable(found);
        registry.warn_of_hidden(found);
        std::vector<EffectInfo> effects;
        for (const std::string& id : registry.ids())
            if (const EffectManifest* manifest = registry.find(id, found))
                effects.push_back(info_of(*manifest));
        if (!faults) stop_at_errors(ErrorKind::document, found);
        else *faults = public_diagnostics(found.all());
        return effects;
    });
}

EffectInfo Host::effect(const std::string& id) const {
    Data& data = Access::host(*this);
    return called(data, [&] {
        EffectRegistry registry = data.registry();
        if (!registry.contains(id))
            fail_at(ErrorKind::usage, "id", "no effect '" + id + "'" + did_you_mean(id, registry.ids()));
        Diagnostics faults;
        const EffectManifest* manifest = registry.find(id, faults);
        stop_at_errors(ErrorKind::document, faults);
        return info_of(*manifest);
    });
}

}  // namespace aftershade::host
