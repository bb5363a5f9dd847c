#include "framework/render/graph_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/document/formula.h"
#include "framework/document/param_type.h"
#include "framework/document/units.h"
#include "framework/graph/rehearsal.h"
#include "framework/image/role.h"
#include "framework/image/step_role.h"
#include "framework/render/step_build.h"

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

int count_value(const CountSpec& count, const ParamReader& params) {
    return count.param.empty() ? count.number : int(std::get<std::int64_t>(params.get(count.param)));
}

std::vector<std::string> copy_defines(gpu::TextureFormat format) {
    if (gpu::is_integer(format)) return {"COPY_UINT"};
    return {};
}

namespace {

int side_of(const GridSpec& grid, int axis, const ParamReader& params, int width, int height) {
    const std::string& formula = grid.formula[axis];
    if (formula.empty()) return grid.size[axis];
    const FormulaResult side = evaluate_formula(formula, [&](std::string_view name) -> std::optional<double> {
        if (is_grid_side(name)) return name == "width" ? width : height;
        const ParamValue& value = params.get(std::string(name));
        const auto* number = std::get_if<double>(&value);
        return number ? *number : double(std::get<std::int64_t>(value));
    });
    // A NaN is no size either.
    if (!(side.value <= kMaxSide))
        throw Error(ErrorKind::effect,
                    "the size \"" + formula + "\" is " + format_number(side.value) +
                        " texels for a frame of " + std::to_string(width) + " x " + std::to_string(height) +
                        "; the limit is " + std::to_string(kMaxSide) + " (write a smaller one" +
                        advice(", or render with a smaller ", Option::scale, "", "") + ")");
    return std::max(1, int(std::max(side.value, 1.0)));
}

}  // namespace

std::pair<int, int> grid_size(const GridSpec& grid, const ParamReader& params, int width, int height) {
    const auto with_room = [&](int side, int axis) {
        const int room = int(std::ceil(side * grid.room[axis]));
        return room == 0 ? side : divided_up(side, kRoomTexels) * kRoomTexels + room;
    };
    switch (grid.kind) {
        case GridSpec::Kind::size:
            return {side_of(grid, 0, params, width, height), side_of(grid, 1, params, width, height)};
        case GridSpec::Kind::tile: {
            const int tile = std::max(1, count_value(grid.tile, params));
            return {divided_up(with_room(width, 0), tile), divided_up(with_room(height, 1), tile)};
        }
        case GridSpec::Kind::scale: break;
    }
    return {with_room(std::max(1, int(std::ceil(width * grid.scale))), 0),
            with_room(std::max(1, int(std::ceil(height * grid.scale))), 1)};
}

std::unique_ptr<BuiltGraph> build_graph(const GraphTools& tools, const GraphFrame& frame) {
    return GraphBuilder(tools, frame).build();
}

GraphBuilder::GraphBuilder(const GraphTools& tools, const GraphFrame& frame)
    : tools_(tools),
      frame_(frame),
      pipeline_(frame.pipeline),
      square_(frame_.square_pixels()),
      square_steps_(frame.pipeline, square_.stretch),
      programs_({tools.context, tools.programs, tools.status,
                 tools.options.fuses_passes && !tools.options.wants_each_pass(), !tools.options.keeps_steps,
                 tools.options.keeps_steps || tools.programs.is_guarding_loops(),
                 tools.options.compile_threads, tools.options.draw_with == DrawWith::compute,
                 !tools.options.plain}),
      built_(std::make_unique<BuiltGraph>()) {}

std::unique_ptr<BuiltGraph> GraphBuilder::build() {
    const int accumulating = pipeline_.last_accumulating_step();
    for (int i = 0; i < int(pipeline_.steps.size()); ++i) {
        built_->first_pass_of_step.push_back(graph_.pass_count());
        use_grid_of(i);
        add_step(i);
        if (i == accumulating) built_->first_single_pass = graph_.pass_count();
    }
    use_grid_of(-1);
    keep_results();
    keep_taps();
    if (tools_.options.telemetry) keep_statistics();
    programs_.finish(graph_, blocks_, built_->first_single_pass);
    std::vector<GraphBinding>& bindings = built_->bindings;
    for (const auto& [image, texture] : imports_)
        bindings.emplace_back(CaptureBinding{image.first, image.second, texture});
    for (ParamBinding& binding : params_) bindings.emplace_back(std::move(binding));
    for (const auto& [step, texture] : masks_) bindings.emplace_back(MaskBinding{step, texture});
    for (NativeTableBinding& binding : native_tables_) bindings.emplace_back(std::move(binding));
    for (BlockBinding& binding : blocks_) bindings.emplace_back(std::move(binding));
    built_->ahead = programs_.take_ahead();
    built_->key = frame_.key();
    // Where threads compile, they draw each pass as well.
    if (tools_.primes && !built_->ahead)
        graph::prime(tools_.context, graph_, graph_.compile(!tools_.options.keeps_steps));
    built_->executor =
        std::make_unique<graph::Executor>(tools_.context, std::move(graph_), !tools_.options.keeps_steps);
    return std::move(built_);
}

std::vector<std::string> GraphBuilder::present_inputs(int index) {
    std::vector<std::string> present;
    const PipelineStep& step = pipeline_.steps[std::size_t(index)];
    for (const InputSpec& input : step.manifest->inputs) {
        const InputSource& source = step.inputs.at(input.name);
        if (step.may_take(input) && (source.step >= 0 || frame_.has_image(source.output, input.frame)))
            present.push_back(input.name);
    }
    return present;
}

void GraphBuilder::add_step(int index) {
    const PipelineStep& step = pipeline_.steps[std::size_t(index)];
    StepBuild build{index, step, frame_.params(index), present_inputs(index)};
    declare(build);
    declare_params(build);
    if (step.manifest->native) declare_native_tables(build);
    for (const PassSpec& pass : step.manifest->passes)
        if (pass_enabled(pass, build.params, build.present)) add_pass(build, pass);
    for (const OutputSpec& output : step.manifest->outputs)
        if (build.textures.at(output.name).version == 0)
            throw Error(ErrorKind::effect, "step '" + step.name + "': no pass writes the output '" +
                                               output.name + "' with these parameters");
    keep_histories(build);
    if (!step.before.empty()) add_mix(build);
    for (const OutputSpec& output : step.manifest->outputs)
        built_->results[output.role] = build.textures.at(output.name);
    built_->textures.push_back(std::move(build.textures));
}

void GraphBuilder::declare(StepBuild& build) {
    const EffectManifest& manifest = build.manifest();
    const std::string prefix = build.prefix();
    for (const InputSpec& input : manifest.inputs) {
        if (std::find(build.present.begin(), build.present.end(), input.name) == build.present.end())
            continue;
        const InputSource& source = build.step.inputs.at(input.name);
        graph::TextureHandle handle = resolve(source, input.frame);
        require_written(build, input, handle);
        handle = on_grid(handle, source);
        build.inputs[input.name] = handle;
        if (!input.history) continue;
        gpu::TextureDesc desc = graph_.textures()[std::size_t(handle.texture)].desc;
        desc.mips = 1;
        const graph::TextureHistory history = graph_.create_history(prefix + "in." + input.name, desc);
        build.previous[input.name] = history.previous;
        build.history_current[input.name] = history.current;
    }
    for (const TextureSpec& spec : manifest.textures) declare_texture(build, spec);
    for (const OutputSpec& spec : manifest.outputs)
        build.textures[spec.name] =
            graph_.create_texture(prefix + spec.name, {width_, height_, texture_format_of_role(spec.role)});
    for (const BufferSpec& spec : manifest.buffers) declare_buffer(build, spec);
}

/// Passes of an earlier step that did not run leave the textures that a look may have wired from it without
/// content.
void GraphBuilder::require_written(const StepBuild& build, const InputSpec& input,
                                   graph::TextureHandle handle) const {
    const auto& texture = graph_.textures()[std::size_t(handle.texture)];
    if (handle.version > 0 || texture.imported || texture.options.clear) return;
    throw Error(ErrorKind::effect, "step '" + build.step.name + "': its input '" + input.name + "' is '" +
                                       texture.name + "', which no pass writes with these parameters");
}

std::optional<int> GraphBuilder::input_level(graph::TextureHandle handle) const {
    return graph_.textures()[std::size_t(handle.texture)].desc.mips > 1 ? std::optional(0) : std::nullopt;
}

/// Whether somebody may look at texels that no pass has drawn. As floats, their bits are not a number, so
/// that an audit finds a pass that reads them.
bool GraphBuilder::shows_undrawn(const StepBuild& build, const TextureSpec& spec) const {
    return tools_.options.wants_each_pass() || std::ranges::any_of(pipeline_.taps, [&](const Tap& tap) {
               return tap.step == build.step.name && tap.texture == spec.name;
           });
}

void GraphBuilder::declare_texture(StepBuild& build, const TextureSpec& spec) {
    const std::string name = build.prefix() + spec.name;
    auto [width, height] = grid_size(spec.grid, build.params, width_, height_);
    // Of a frame of a few pixels too, passes read and write every level that the manifest names.
    if (!spec.auto_mips && spec.mips > 1 && std::max(width, height) < 1 << (spec.mips - 1))
        width = 1 << (spec.mips - 1);
    const int most_mips = int(std::bit_width(unsigned(std::max(width, height))));
    const int mips = spec.auto_mips ? most_mips : std::min(spec.mips, most_mips);
    const gpu::TextureDesc desc{width, height, spec.format, spec.layers, mips};
    graph::TextureOptions options;
    options.auto_mips = spec.auto_mips;
    options.partial = spec.partial;
    if (spec.clear) options.clear = four_values(*spec.clear);
    if (spec.partial && shows_undrawn(build, spec)) {
        const double all_bits = gpu::is_signed_integer(spec.format) ? -1.0 : double(UINT32_MAX);
        options.clear = {all_bits, all_bits, all_bits, all_bits};
    }
    if (!spec.history) {
        build.textures[spec.name] = graph_.create_texture(name, desc, options);
        return;
    }
    const graph::TextureHistory history = graph_.create_history(name, desc, options);
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
        build.buffers[spec.name] = graph_.create_buffer(name, desc, clear_words(spec));
        return;
    }
    const graph::BufferHistory history = graph_.create_history_buffer(name, desc, clear_words(spec));
    build.previous_buffers[spec.name] = history.previous;
    build.buffers[spec.name] = history.current;
}

graph::TextureHandle GraphBuilder::import(const RoleId& role, int offset) {
    const std::pair image(role, offset);
    const auto known = imports_.find(image);
    if (known != imports_.end()) return known->second;
    const std::string where = offset == 0    ? "capture."
                              : offset == -1 ? "previous."
                              : offset == 1  ? "next."
                              : offset < 0   ? std::to_string(-offset) + " frames before."
                                             : std::to_string(offset) + " frames after.";
    // Passes that run once a frame may need what those of each sub-frame have left.
    const bool is_given_each_run = pipeline_.last_accumulating_step() < 0;
    return imports_[image] = graph_.import_texture(
               where + role.name(), {frame_.width_px(), frame_.height_px(), texture_format_of_role(role)},
               is_given_each_run);
}

graph::TextureHandle GraphBuilder::resolve(const InputSource& source, int offset) {
    return source.step < 0 ? import(source.output, offset)
                           : built_->textures[std::size_t(source.step)].at(source.output);
}

void GraphBuilder::declare_params(StepBuild& build) {
    const auto& files = tools_.files.of_step(build.index, build.step, build.params);
    for (const ParamSpec& spec : build.manifest().params) {
        const std::string name = build.prefix() + spec.name;
        ParamBinding binding{build.index, &spec};
        if (is_param_buffer(spec.type))
            binding.buffer = build.param_buffers[spec.name] =
                graph_.import_buffer(name, {table_buffer_bytes(spec, build.params.table_entries(spec))});
        if (is_param_texture(spec.type)) {
            const TexelSize size = build.params.texture_size(spec);
            binding.texture =
                graph_.import_texture(name + std::string(spec.type->texture->label()),
                                      {size.width, size.height, param_texture_format(size.channels)});
        } else if (is_file_type(spec.type) && !std::holds_alternative<std::monostate>(files.at(spec.name))) {
            const ParamTexture texture = file_texture(files.at(spec.name));
            binding.texture =
                graph_.import_texture(name, {texture.width, texture.height, texture.format, texture.layers});
        }
        if (binding.texture) build.param_textures[spec.name] = *binding.texture;
        if (binding.texture || binding.buffer) params_.push_back(binding);
    }
}

void GraphBuilder::declare_native_tables(StepBuild& build) {
    for (const NativeTableSpec& table : build.manifest().native->tables) {
        const graph::TextureHandle texture =
            graph_.import_texture(build.prefix() + table.name, frame_.native_table(build.index, table));
        build.native_tables[table.name] = texture;
        native_tables_.push_back({build.index, table.name, texture});
    }
}

void GraphBuilder::bind_block(const StepBuild& build, BlockKind kind, graph::Pass& pass) {
    pass.uniforms.push_back({gl_binding(kind), std::vector<std::byte>(block_bytes(kind, build.manifest()))});
    const auto same = [&](const BlockBinding& block) {
        return block.kind == kind &&
               (block.step == build.index || (kind == BlockKind::camera && grid_of(block.step) == grid_));
    };
    auto block = std::find_if(blocks_.begin(), blocks_.end(), same);
    if (block == blocks_.end()) block = blocks_.insert(block, BlockBinding{kind, build.index, {}});
    block->places.push_back({graph_.pass_count(), gl_binding(kind)});
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
    graph::Pass pass;
    pass.name = build.step.name + "." + name + ".keep";
    pass.reads.push_back({from, 0, gpu::Filter::nearest, gpu::Wrap::clamp, input_level(from)});
    pass.targets.push_back({to});
    programs_.give_host(graph_, pass, "copy.frag",
                        copy_defines(graph_.textures()[std::size_t(from.texture)].desc.format));
    (void)graph_.add_pass(std::move(pass));
}

void GraphBuilder::add_mix(StepBuild& build) {
    const PipelineStep& step = build.step;
    for (const auto& [name, source] : step.before) {
        graph::Pass pass;
        pass.name = step.name + "." + name + ".mix";
        std::vector<std::string> defines;
        // A coverage is resampled as a mask is; its name alone is not a role.
        const auto mask_image = [&](const RoleId& role) {
            return on_grid(import(role), {-1, role.is_coverage() ? kMaskRole : role.name()});
        };
        const auto role = find_role(build.manifest().find_output(name)->role);
        if (is_step_role(role->name) && !role->filterable) defines.emplace_back("WHOLE_OR_NOTHING");
        if (source.output.empty()) {
            defines.emplace_back(role->outside == 0 ? "NOTHING_IS_0" : "NOTHING_IS_1");
        } else {
            const graph::TextureHandle before = on_grid(resolve(source), source);
            pass.reads.push_back({before, 0, gpu::Filter::nearest, gpu::Wrap::clamp, input_level(before)});
        }
        pass.reads.push_back({build.textures.at(name), 1});
        if (step.mask && !step.mask->role.empty()) {
            defines.emplace_back("MASK_IMAGE");
            pass.reads.push_back({mask_image(step.mask->role), 2});
        } else if (step.mask && step.mask->names_objects() &&
                   frame_.has_image(RoleId::coverage(step.mask->objects), 0)) {
            defines.emplace_back("MASK_IMAGE");
            pass.reads.push_back({mask_image(RoleId::coverage(step.mask->objects)), 2});
        } else if (step.mask && !step.mask->objects.empty()) {
            defines.emplace_back("MASK_OBJECTS");
            pass.reads.push_back({mask_image(kObjectIdRole), 2});
        } else if (step.mask) {
            defines.emplace_back("MASK_FILE");
            pass.reads.push_back({mask_of(build), 2, gpu::Filter::linear});
        }
        bind_block(build, BlockKind::mix, pass);
        const gpu::TextureDesc desc = graph_.textures()[std::size_t(build.textures.at(name).texture)].desc;
        pass.targets.push_back({graph_.create_texture(pass.name, desc)});
        programs_.give_host(graph_, pass, "mix.frag", defines);
        build.textures[name] = graph_.add_pass(std::move(pass)).targets[0];
    }
}

graph::TextureHandle GraphBuilder::mask_of(const StepBuild& build) {
    if (const auto known = masks_.find(build.index); known != masks_.end()) return known->second;
    const Image& mask = tools_.files.mask_of(build.step.mask->file);
    return masks_[build.index] = graph_.import_texture(
               build.step.name + ".mask", {mask.width(), mask.height(), gpu::TextureFormat::r32f});
}

}  // namespace aftershade
