#include "framework/pipeline/graph_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "framework/core/error.h"
#include "framework/image/role.h"
#include "framework/pipeline/frame_blocks.h"
#include "framework/pipeline/step_build.h"

namespace aftershade {

namespace {

int divided_up(int value, int by) {
    return (value + by - 1) / by;
}

/// Bytes from one element of a std430 array to the next.
std::size_t element_bytes(const std::string& element) {
    return element.ends_with("4") ? 16 : element.ends_with("2") ? 8 : 4;
}

/// The first words of a cleared buffer, as its elements hold them.
std::optional<std::vector<std::uint32_t>> clear_words(const BufferSpec& spec) {
    if (spec.clear.empty()) return std::nullopt;
    const bool is_integer = spec.element.starts_with("u") || spec.element.starts_with("i");
    std::vector<std::uint32_t> words;
    for (const double value : spec.clear)
        words.push_back(is_integer ? std::uint32_t(std::int64_t(value))
                                   : std::bit_cast<std::uint32_t>(float(value)));
    return words;
}

}  // namespace

std::array<double, 4> four_values(const std::vector<double>& values) {
    if (values.empty()) return {0, 0, 0, 0};
    if (values.size() == 1) return {values[0], values[0], values[0], values[0]};
    std::array<double, 4> result = {0, 0, 0, 0};
    std::copy_n(values.begin(), std::min<std::size_t>(4, values.size()), result.begin());
    return result;
}

int count_value(const CountSpec& count, const ParamSet& params) {
    return count.param.empty() ? count.number : int(std::get<std::int64_t>(params.get(count.param)));
}

std::pair<int, int> grid_size(const GridSpec& grid, const ParamSet& params, int width, int height) {
    switch (grid.kind) {
        case GridSpec::Kind::size: return {grid.size[0], grid.size[1]};
        case GridSpec::Kind::tile: {
            const int tile = std::max(1, count_value(grid.tile, params));
            return {divided_up(width, tile), divided_up(height, tile)};
        }
        case GridSpec::Kind::scale: break;
    }
    return {std::max(1, int(std::ceil(width * grid.scale))),
            std::max(1, int(std::ceil(height * grid.scale)))};
}

GraphBuilder::GraphBuilder(ProgramCache& programs, StepFiles& files, const NativeSteps& natives,
                           const Pipeline& pipeline, const FrameInputs& frame)
    : programs_(programs), files_(files), natives_(natives), pipeline_(pipeline), frame_(frame) {
    width_ = frame.capture->header.data_window.width();
    height_ = frame.capture->header.data_window.height();
}

void GraphBuilder::add_step(int index, const ParamSet& params) {
    const PipelineStep& step = pipeline_.steps[std::size_t(index)];
    StepBuild build{index, step, params, present_inputs(pipeline_, index, frame_), {}, {}, {}, {}, {}, {},
                    {},    {},   {}};
    declare(build);
    declare_params(build);
    if (const NativeResult* native = natives_.result(index))
        for (const auto& [name, table] : native->tables)
            build.native_tables[name] = native_tables[index][name] =
                graph.import_texture(build.prefix() + name, table_desc(table));
    for (const PassSpec& pass : step.manifest->passes)
        if (pass_enabled(pass, params, build.present)) add_pass(build, pass);
    for (const OutputSpec& output : step.manifest->outputs)
        if (build.textures.at(output.name).version == 0)
            throw Error(ExitCode::effect, "step '" + step.name + "': no pass writes the output '" +
                                              output.name + "' with these parameters");
    keep_histories(build);
    if (!step.before.empty()) add_mix(build);
    steps_.push_back(std::move(build.textures));
}

void GraphBuilder::declare(StepBuild& build) {
    const EffectManifest& manifest = build.manifest();
    const std::string prefix = build.prefix();
    for (const InputSpec& input : manifest.inputs) {
        if (std::find(build.present.begin(), build.present.end(), input.name) == build.present.end())
            continue;
        const auto handle = resolve(build.step.inputs.at(input.name), input.frame);
        require_written(build, input, handle);
        build.inputs[input.name] = handle;
        if (!input.history) continue;
        gpu::TextureDesc desc = graph.textures()[std::size_t(handle.texture)].desc;
        desc.mips = 1;
        const graph::TextureHistory history = graph.create_history(prefix + "in." + input.name, desc);
        build.previous[input.name] = history.previous;
        build.history_current[input.name] = history.current;
    }
    for (const TextureSpec& spec : manifest.textures) declare_texture(build, spec);
    for (const OutputSpec& spec : manifest.outputs)
        build.textures[spec.name] =
            graph.create_texture(prefix + spec.name, {width_, height_, texture_format_of_role(spec.role)});
    for (const BufferSpec& spec : manifest.buffers) declare_buffer(build, spec);
}

/// Passes of an earlier step that did not run leave the textures that a look may have wired from it without
/// content.
void GraphBuilder::require_written(const StepBuild& build, const InputSpec& input,
                                   graph::TextureHandle handle) const {
    const auto& texture = graph.textures()[std::size_t(handle.texture)];
    if (handle.version > 0 || texture.imported || texture.options.clear) return;
    throw Error(ExitCode::effect, "step '" + build.step.name + "': its input '" + input.name + "' is '" +
                                      texture.name + "', which no pass writes with these parameters");
}

int GraphBuilder::input_level(graph::TextureHandle handle) const {
    return graph.textures()[std::size_t(handle.texture)].desc.mips > 1 ? 0 : -1;
}

void GraphBuilder::declare_texture(StepBuild& build, const TextureSpec& spec) {
    const std::string name = build.prefix() + spec.name;
    const auto [width, height] = grid_size(spec.grid, build.params, width_, height_);
    const int most_mips = int(std::bit_width(unsigned(std::max(width, height))));
    const int mips = spec.auto_mips ? most_mips : std::min(spec.mips, most_mips);
    const gpu::TextureDesc desc{width, height, spec.format, spec.layers, mips};
    graph::TextureOptions options;
    options.auto_mips = spec.auto_mips;
    if (spec.clear) options.clear = four_values(*spec.clear);
    if (!spec.history) {
        build.textures[spec.name] = graph.create_texture(name, desc, options);
        return;
    }
    const graph::TextureHistory history = graph.create_history(name, desc, options);
    build.previous[spec.name] = history.previous;
    build.textures[spec.name] = build.history_current[spec.name] = history.current;
}

void GraphBuilder::declare_buffer(StepBuild& build, const BufferSpec& spec) {
    const std::string name = build.prefix() + spec.name;
    std::size_t count = std::size_t(count_value(spec.count, build.params));
    if (spec.grid) {
        const auto [width, height] = grid_size(*spec.grid, build.params, width_, height_);
        count *= std::size_t(width) * std::size_t(height);
    }
    const graph::BufferDesc desc{std::max<std::size_t>(16, count * element_bytes(spec.element))};
    if (!spec.history) {
        build.buffers[spec.name] = graph.create_buffer(name, desc, clear_words(spec));
        return;
    }
    const graph::BufferHistory history = graph.create_history_buffer(name, desc, clear_words(spec));
    build.previous_buffers[spec.name] = history.previous;
    build.buffers[spec.name] = history.current;
}

graph::TextureHandle GraphBuilder::import(const std::string& role, int offset) {
    const ImportKey key{role, offset};
    const auto known = imports.find(key);
    if (known != imports.end()) return known->second;
    const std::string where = offset < 0 ? "previous." : offset > 0 ? "next." : "capture.";
    return imports[key] = graph.import_texture(where + role, {width_, height_, texture_format_of_role(role)});
}

graph::TextureHandle GraphBuilder::resolve(const InputSource& source, int offset) {
    return source.step < 0 ? import(source.output, offset)
                           : steps_[std::size_t(source.step)].at(source.output);
}

void GraphBuilder::declare_params(StepBuild& build) {
    const auto& files = files_.of_step(build.index, build.step, build.params);
    for (const ParamSpec& spec : build.manifest().params) {
        const std::string name = build.prefix() + spec.name;
        BoundParam bound{build.index, &spec, {}, {}};
        const ParamValue& value = build.params.get(spec.name);
        if (is_param_buffer(spec.type)) {
            const auto no_names = [](const std::string&) { return std::optional<std::uint32_t>(0); };
            bound.buffer = build.param_buffers[spec.name] =
                graph.import_buffer(name, {table_buffer(spec, table_of(value), no_names).size()});
        }
        if (const auto* scattering = std::get_if<ScatteringValue>(&value)) {
            const int rows = kScatteringRows * int(scattering_profiles_of(*scattering).size());
            bound.texture = build.param_textures[spec.name] = graph.import_texture(
                name + ".curves", {kScatteringSamples, rows, gpu::TextureFormat::rgba32f});
        } else if (spec.type == ParamType::curve) {
            bound.texture = build.param_textures[spec.name] =
                graph.import_texture(name, {kCurveSamples, 1, gpu::TextureFormat::r32f});
        } else if (spec.type == ParamType::file &&
                   !std::holds_alternative<std::monostate>(files.at(spec.name))) {
            const ParamTexture texture = file_texture(files.at(spec.name));
            bound.texture = build.param_textures[spec.name] =
                graph.import_texture(name, {texture.width, texture.height, texture.format, texture.layers});
        } else if (!is_param_buffer(spec.type)) {
            continue;
        }
        bound_params.push_back(bound);
    }
}

void GraphBuilder::keep_histories(StepBuild& build) {
    for (const auto& [name, current] : build.history_current) {
        const auto input = build.inputs.find(name);
        if (input != build.inputs.end()) {
            add_copy(build, name, input->second, current);
            continue;
        }
        // A texture that was read and written by one pass lies elsewhere now.
        const graph::TextureHandle live = build.textures.at(name);
        if (live.texture != current.texture) add_copy(build, name, live, current);
    }
}

void GraphBuilder::add_copy(StepBuild& build, const std::string& name, graph::TextureHandle from,
                            graph::TextureHandle to) {
    const bool is_integer = gpu::is_integer(graph.textures()[std::size_t(from.texture)].desc.format);
    graph::Pass pass;
    pass.name = build.step.name + "." + name + ".keep";
    pass.program = &programs_.host(
        "copy.frag", is_integer ? std::vector<std::string>{"COPY_UINT"} : std::vector<std::string>{});
    pass.reads.push_back({from, 0, gpu::Filter::nearest, gpu::Wrap::clamp, input_level(from)});
    pass.targets.push_back({to});
    (void)graph.add_pass(std::move(pass));
    passes.push_back({build.index, graph.pass_count() - 1, false, true});
}

void GraphBuilder::add_mix(StepBuild& build) {
    const PipelineStep& step = build.step;
    for (const auto& [name, source] : step.before) {
        graph::Pass pass;
        pass.name = step.name + "." + name + ".mix";
        std::vector<std::string> defines;
        const graph::TextureHandle before = resolve(source);
        pass.reads = {{before, 0, gpu::Filter::nearest, gpu::Wrap::clamp, input_level(before)},
                      {build.textures.at(name), 1}};
        if (step.mask && !step.mask->role.empty()) {
            defines = {"MASK_IMAGE"};
            pass.reads.push_back({import(step.mask->role), 2});
        } else if (step.mask && !step.mask->objects.empty()) {
            defines = {"MASK_OBJECTS"};
            pass.reads.push_back({import(kObjectIdRole), 2});
        } else if (step.mask) {
            defines = {"MASK_FILE"};
            if (!mask_files.contains(build.index)) {
                const Image& mask = files_.mask_of(step.mask->file);
                mask_files[build.index] = graph.import_texture(
                    step.name + ".mask", {mask.width(), mask.height(), gpu::TextureFormat::r32f});
            }
            pass.reads.push_back({mask_files.at(build.index), 2, gpu::Filter::linear});
        }
        pass.program = &programs_.host("mix.frag", defines);
        pass.uniforms.push_back({0, mix_block(step, frame_)});
        const gpu::TextureDesc desc = graph.textures()[std::size_t(build.textures.at(name).texture)].desc;
        pass.targets.push_back({graph.create_texture(pass.name, desc)});
        build.textures[name] = graph.add_pass(std::move(pass)).targets[0];
        passes.push_back({build.index, graph.pass_count() - 1, true, false});
    }
}

}  // namespace aftershade
