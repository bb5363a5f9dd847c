#include "framework/pipeline/built_graph.h"

#include <utility>

#include "framework/core/error.h"

namespace aftershade {

namespace {

void add_count(std::string& key, const CountSpec& count, const ParamSet& params) {
    if (!count.param.empty()) key += " " + format_value(params.get(count.param));
}

void add_grid(std::string& key, const std::optional<GridSpec>& grid, const ParamSet& params) {
    if (grid) add_count(key, grid->tile, params);
}

void add_conditions(std::string& key, const std::vector<WhenSpec>& conditions, const ParamSet& params) {
    for (const WhenSpec& condition : conditions)
        if (params.has(condition.subject)) key += " " + format_value(params.get(condition.subject));
}

void add_pass_key(std::string& key, const PassSpec& pass, const ParamSet& params) {
    add_conditions(key, pass.when, params);
    for (const ReadSpec& read : pass.reads) add_conditions(key, read.when, params);
    for (const WriteSpec& write : pass.writes) add_conditions(key, write.when, params);
    for (const AccessSpec& image : pass.images) add_conditions(key, image.when, params);
    if (pass.repeat) add_count(key, *pass.repeat, params);
    add_count(key, pass.dispatch.tile, params);
    if (!pass.instances) return;
    add_count(key, pass.instances->count, params);
    add_grid(key, pass.instances->grid, params);
}

void add_step_key(std::string& key, const EffectManifest& manifest, const ParamSet& params) {
    for (const ParamSpec& spec : manifest.params) {
        const ParamValue& value = params.get(spec.name);
        if (spec.bind == ParamBind::define || spec.type == ParamType::file) key += " " + format_value(value);
        if (const auto* table = std::get_if<TableValue>(&value))
            key += " " + std::to_string(table->rows.size());
        if (const auto* scattering = std::get_if<ScatteringValue>(&value))
            key += " " + std::to_string(scattering->rows.size()) + "/" +
                   std::to_string(scattering_profiles_of(*scattering).size()) +
                   (is_burley(*scattering) ? "b" : "");
    }
    for (const TextureSpec& texture : manifest.textures) add_grid(key, texture.grid, params);
    for (const BufferSpec& buffer : manifest.buffers) {
        add_grid(key, buffer.grid, params);
        add_count(key, buffer.count, params);
    }
    for (const PassSpec& pass : manifest.passes) add_pass_key(key, pass, params);
}

void keep_taps(const Pipeline& pipeline, const GraphBuilder& builder, graph::FrameGraph& graph) {
    for (const Tap& tap : pipeline.taps)
        for (std::size_t i = 0; i < pipeline.steps.size(); ++i) {
            if (pipeline.steps[i].name != tap.step) continue;
            const graph::TextureHandle handle = builder.textures_of(int(i)).at(tap.texture);
            if (handle.version == 0)
                throw Error(ExitCode::usage,
                            "--tap " + tap.text() + ": no pass writes it with these parameters");
            graph.keep(handle);
        }
}

void keep_statistics(const Pipeline& pipeline, const std::vector<GraphBuilder::Textures>& textures,
                     graph::FrameGraph& graph) {
    for (std::size_t i = 0; i < pipeline.steps.size(); ++i)
        for (const TelemetrySpec& spec : pipeline.steps[i].manifest->telemetry)
            if (const auto found = find_textures(textures[i], spec)) {
                graph.keep(found->of);
                if (found->where) graph.keep(*found->where);
            }
}

}  // namespace

std::optional<StatisticTextures> find_textures(const GraphBuilder::Textures& textures,
                                               const TelemetrySpec& spec) {
    StatisticTextures found{textures.at(spec.of.texture), std::nullopt};
    if (spec.where) found.where = textures.at(spec.where->texture);
    if (found.of.version == 0 || (found.where && found.where->version == 0)) return std::nullopt;
    return found;
}

std::string graph_key(const Pipeline& pipeline, const FrameInputs& frame, const std::vector<ParamSet>& params,
                      const std::vector<std::string>& roles) {
    const Window& window = frame.capture->header.data_window;
    std::string key = std::to_string(window.width()) + "x" + std::to_string(window.height());
    for (const int offset : {-1, 0, 1})
        if (const Capture* capture = frame.at(offset))
            for (const auto& [role, image] : capture->images) key += " " + std::to_string(offset) + role;
    for (const std::string& role : roles) key += " >" + role;
    for (std::size_t i = 0; i < pipeline.steps.size(); ++i)
        add_step_key(key, *pipeline.steps[i].manifest, params[i]);
    return key;
}

std::unique_ptr<BuiltGraph> build_graph(gpu::Context& context, ProgramCache& programs, StepFiles& files,
                                        const NativeSteps& natives, const Pipeline& pipeline,
                                        const FrameInputs& frame, const std::vector<ParamSet>& params,
                                        const std::vector<std::string>& roles, bool telemetry) {
    auto built = std::make_unique<BuiltGraph>();
    GraphBuilder builder(programs, files, natives, pipeline, frame);
    const int accumulating = pipeline.last_accumulating_step();
    for (int i = 0; i < int(pipeline.steps.size()); ++i) {
        builder.add_step(i, params[std::size_t(i)]);
        built->textures.push_back(builder.textures_of(i));
        for (const OutputSpec& output : pipeline.steps[std::size_t(i)].manifest->outputs)
            built->results[output.role] = built->textures.back().at(output.name);
        if (i == accumulating) built->first_single_pass = builder.graph.pass_count();
    }
    for (const std::string& role : roles)
        if (const auto result = built->results.find(role); result != built->results.end())
            builder.graph.keep(result->second);
    keep_taps(pipeline, builder, builder.graph);
    if (telemetry) keep_statistics(pipeline, built->textures, builder.graph);
    built->imports = std::move(builder.imports);
    built->mask_files = std::move(builder.mask_files);
    built->passes = std::move(builder.passes);
    built->params = std::move(builder.bound_params);
    built->native_tables = std::move(builder.native_tables);
    built->uploaded.resize(built->params.size());
    built->executor = std::make_unique<graph::Executor>(context, std::move(builder.graph));
    return built;
}

}  // namespace aftershade
