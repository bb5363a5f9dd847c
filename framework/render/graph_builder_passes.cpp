// One pass of an effect as passes of the graph: the second half of GraphBuilder.
#include <algorithm>
#include <array>
#include <utility>

#include "framework/base/error.h"
#include "framework/effect/std140.h"
#include "framework/render/frame_blocks.h"
#include "framework/render/graph_builder.h"
#include "framework/render/step_build.h"

namespace aftershade {

namespace {

gpu::Access gpu_access(AccessSpec::Kind kind) {
    switch (kind) {
        case AccessSpec::Kind::read: return gpu::Access::read;
        case AccessSpec::Kind::write: return gpu::Access::write;
        case AccessSpec::Kind::atomic: break;
    }
    return gpu::Access::read_write;
}

std::array<float, 4> size_of(const gpu::TextureDesc& desc, int level) {
    const int width = std::max(1, desc.width >> level);
    const int height = std::max(1, desc.height >> level);
    return {float(width), float(height), 1.0f / float(width), 1.0f / float(height)};
}

[[noreturn]] void unwritten(const StepBuild& build, const PassSpec& spec, const std::string& name) {
    throw Error(ErrorKind::effect, "step '" + build.step.name + "': pass '" + spec.name + "' reads '" + name +
                                       "', which no pass has written with these parameters");
}

/// Texels of a level of a texture or an output per px of the working grid, along a side.
double texels_per_px(const EffectManifest& manifest, const ParamReader& params, const std::string& name,
                     int level) {
    const TextureSpec* texture = manifest.find_texture(name);
    if (!texture) return 1;
    const GridSpec& grid = texture->grid;
    const double scale =
        grid.kind == GridSpec::Kind::tile ? 1.0 / std::max(1, count_value(grid.tile, params)) : grid.scale;
    return scale / (1 << level);
}

/// Samplers of a pass, and the block of their sizes, which ends with `tile_grid` where the pass has one.
void bind_reads(const StepBuild& build, const PassSpec& spec, const PassBindings& bindings, int turn,
                const std::array<float, 4>& tile_grid, const graph::FrameGraph& graph, graph::Pass& pass) {
    Std140Writer sizes;
    for (const ReadSpec& read : bindings.reads) {
        const graph::TextureHandle handle =
            read.previous ? build.previous.at(read.name) : build.read_handle(read.name);
        const auto& texture = graph.textures()[std::size_t(handle.texture)];
        if (handle.version == 0 && !texture.options.clear) unwritten(build, spec, read.name);
        const bool is_input = !read.previous && build.inputs.contains(read.name);
        // An earlier step's texture may have levels, which an input has not.
        std::optional<int> level;
        if (read.level) level = read.level->in_turn(turn);
        else if (is_input && texture.desc.mips > 1) level = 0;
        pass.reads.push_back({handle, int(pass.reads.size()), read.filter, read.wrap, level, read.is_pixel});
        const auto size = size_of(texture.desc, level.value_or(0));
        sizes.add(std::span<const float>(size));
    }
    for (const WriteSpec& write : bindings.sized_writes) {
        const auto& texture = graph.textures()[std::size_t(build.textures.at(write.name).texture)];
        const auto size = size_of(texture.desc, write.level.in_turn(turn));
        sizes.add(std::span<const float>(size));
    }
    if (bindings.has_tile_grid) sizes.add(std::span<const float>(tile_grid));
    if (bindings.has_sizes()) pass.uniforms.push_back({kSizeBinding, sizes.finish()});
    for (const ParamSpec* param : bindings.param_samplers)
        pass.reads.push_back({build.param_textures.at(param->name), int(pass.reads.size()),
                              param->file_is_linear ? gpu::Filter::linear : gpu::Filter::nearest});
    for (const NativeTableSpec* table : bindings.native_tables)
        pass.reads.push_back({build.native_tables.at(table->name), int(pass.reads.size())});
}

void bind_memory(const StepBuild& build, const PassBindings& bindings, graph::Pass& pass) {
    for (const AccessSpec& image : bindings.images)
        pass.images.push_back(
            {build.textures.at(image.name), int(pass.images.size()), gpu_access(image.kind), 0});
    for (const AccessSpec& use : bindings.buffers) {
        const auto& buffers = use.previous ? build.previous_buffers : build.buffers;
        pass.buffers.push_back({buffers.at(use.name), int(pass.buffers.size()), gpu_access(use.kind)});
    }
    for (const ParamSpec* param : bindings.param_buffers)
        pass.buffers.push_back(
            {build.param_buffers.at(param->name), int(pass.buffers.size()), gpu::Access::read});
}

}  // namespace

void GraphBuilder::add_pass(StepBuild& build, const PassSpec& spec) {
    const bool is_native = build.manifest().native.has_value();
    if (is_native && !frame_.native_enabled(build.index, spec.name)) return;
    if (spec.clear()) return add_clear(build, spec);
    if (spec.copies()) return add_copy_pass(build, spec);
    int turns = spec.repeat ? count_value(*spec.repeat, build.params) : 1;
    if (is_native) turns = frame_.native_turns(build.index, spec.name, turns);
    for (int turn = 0; turn < turns; ++turn) add_turn(build, spec, turn, turns);
}

namespace {

/// By the manifest; what the shader's text forbids is found later.
graph::Fusing fusing_of(const PassSpec& spec, const graph::Pass& pass) {
    const bool is_plain = pass.kind == graph::PassKind::draw && spec.fills_screen() &&
                          pass.blend == gpu::Blend::none && pass.images.empty() && !spec.repeat &&
                          std::ranges::all_of(pass.buffers, [](const graph::BufferUse& use) {
                              return use.access == gpu::Access::read;
                          });
    if (!is_plain) return graph::Fusing::never;
    const bool follows = std::ranges::any_of(pass.reads, &graph::Read::is_pixel);
    return follows ? graph::Fusing::follows : graph::Fusing::leads;
}

}  // namespace

void GraphBuilder::add_clear(StepBuild& build, const PassSpec& spec) {
    graph::Pass pass;
    pass.name = build.step.name + "." + spec.name;
    pass.kind = graph::PassKind::clear;
    pass.clear_value = four_values(spec.clear()->value);
    const std::vector<WriteSpec> writes = present_writes(spec, build.params, build.present);
    for (const WriteSpec& write : writes)
        pass.targets.push_back({build.textures.at(write.name), write.level.number, write.layer.number});
    const graph::Written written = graph_.add_pass(std::move(pass));
    for (std::size_t i = 0; i < writes.size(); ++i) build.textures[writes[i].name] = written.targets[i];
}

/// An input that an earlier step made may have another format than the role: then a draw converts it.
void GraphBuilder::add_copy_pass(StepBuild& build, const PassSpec& spec) {
    const ReadSpec& read = spec.reads.front();
    const graph::TextureHandle from =
        read.previous ? build.previous.at(read.name) : build.read_handle(read.name);
    const std::string& name = spec.writes.front().name;
    const graph::TextureHandle to = build.textures.at(name);
    const auto& source = graph_.textures()[std::size_t(from.texture)];
    const gpu::TextureDesc &a = source.desc, &b = graph_.textures()[std::size_t(to.texture)].desc;
    if (from.version == 0 && !source.options.clear) unwritten(build, spec, read.name);
    graph::Pass pass;
    pass.name = build.prefix() + spec.name;
    pass.reads.push_back({from, 0, gpu::Filter::nearest, gpu::Wrap::clamp, input_level(from)});
    pass.targets.push_back({to});
    if (a.format == b.format && a.width == b.width && a.height == b.height && a.layers == 1) {
        pass.kind = graph::PassKind::copy;
        if (b.mips > 1) pass.reads.front().level = pass.targets.front().level = std::nullopt;
    } else {
        programs_.give_host(graph_, pass, "copy.frag", copy_defines(a.format));
    }
    build.textures[name] = graph_.add_pass(std::move(pass)).targets.front();
}

void GraphBuilder::add_turn(StepBuild& build, const PassSpec& spec, int turn, int turns) {
    const EffectManifest& manifest = build.manifest();
    const ShaderContext shader{&manifest,
                               &spec,
                               build.params,
                               build.present,
                               tools_.programs.glsl_folder(),
                               &tools_.files.of_step(build.index, build.step, build.params)};
    const PassBindings bindings = pass_bindings(shader);
    graph::Pass pass;
    pass.name = build.prefix() + spec.name + (turns > 1 ? "[" + std::to_string(turn) + "]" : "");
    bind_reads(build, spec, bindings, turn, tile_grid_size(build, spec, bindings), graph_, pass);
    if (spec.over() && !spec.vertex())
        pass.uniforms.push_back({kTilesBinding, tiles_block(build, spec, bindings)});
    bind_memory(build, bindings, pass);
    if (bindings.has_param_block) bind_block(build, BlockKind::param, pass);
    bind_block(build, BlockKind::frame, pass);
    bind_block(build, BlockKind::camera, pass);
    if (manifest.uses_lights) bind_block(build, BlockKind::lights, pass);
    if (bindings.has_native_block) bind_block(build, BlockKind::native, pass);
    if (spec.repeat) pass.uniforms.push_back({kPassBinding, bytes_of(PassBlock{turn, turns})});
    for (const WriteSpec& write : bindings.writes)
        pass.targets.push_back({write_target(build, bindings, write.name, pass.name),
                                write.level.in_turn(turn), write.layer.in_turn(turn)});
    set_kind(build, spec, pass);
    pass.fusing = fusing_of(spec, pass);
    programs_.add(graph_.pass_count(), shader, build.step);
    const graph::Written written = graph_.add_pass(std::move(pass));
    for (std::size_t i = 0; i < bindings.writes.size(); ++i)
        build.textures[bindings.writes[i].name] = written.targets[i];
    for (std::size_t i = 0; i < bindings.images.size(); ++i)
        build.textures[bindings.images[i].name] = written.images[i];
    for (std::size_t i = 0; i < bindings.buffers.size(); ++i)
        if (!bindings.buffers[i].previous) build.buffers[bindings.buffers[i].name] = written.buffers[i];
}

/// Of the grid that a tile list divides, texels.
std::array<float, 2> GraphBuilder::listed_size(const StepBuild& build, const TileListSpec& list) const {
    if (list.on.empty()) return {float(width_), float(height_)};
    const auto& desc = graph_.textures()[std::size_t(build.textures.at(list.on).texture)].desc;
    return {float(desc.width), float(desc.height)};
}

/// How many texels of the tile list's grid there are: on a target of another scale as many as it covers.
std::array<float, 4> GraphBuilder::tile_grid_size(const StepBuild& build, const PassSpec& spec,
                                                  const PassBindings& bindings) const {
    if (!spec.over() && !spec.lists()) return {};
    const TileListSpec& list = *build.manifest().tile_list_of(spec);
    const std::string& on = spec.lists() ? list.on : bindings.writes.front().name;
    const int level = spec.lists() ? 0 : bindings.writes.front().level.number;
    float width = float(width_), height = float(height_);
    if (!on.empty()) {
        const auto& desc = graph_.textures()[std::size_t(build.textures.at(on).texture)].desc;
        const double scale = texels_per_px(build.manifest(), build.params, list.on, 0) /
                             texels_per_px(build.manifest(), build.params, on, level);
        width = float(std::max(1, desc.width >> level) * scale);
        height = float(std::max(1, desc.height >> level) * scale);
    }
    return {width, height, 1 / width, 1 / height};
}

/// Of glsl/host/tiles.vert, and behind it for compute shaders how many tiles the list has across and down.
std::vector<std::byte> GraphBuilder::tiles_block(const StepBuild& build, const PassSpec& spec,
                                                 const PassBindings& bindings) const {
    const std::array<float, 4> grid = tile_grid_size(build, spec, bindings);
    const TileListSpec& list = *build.manifest().tile_list_of(spec);
    const int side = count_value(list.tile, build.params);
    Std140Writer block;
    block.add(std::span<const float>(grid));
    block.add(std::int32_t(side));
    for (const float texels : listed_size(build, list))
        block.add(std::int32_t((int(texels) + side - 1) / side));
    return block.finish();
}

/// A draw that reads what it writes gets memory of its own to write to: the reads keep what was before.
graph::TextureHandle GraphBuilder::write_target(const StepBuild& build, const PassBindings& bindings,
                                                const std::string& name, const std::string& pass) {
    const graph::TextureHandle handle = build.textures.at(name);
    const auto reads_it = [&](const ReadSpec& read) {
        return read.name == name && !read.previous && !read.level && !build.inputs.contains(name);
    };
    if (std::none_of(bindings.reads.begin(), bindings.reads.end(), reads_it)) return handle;
    const auto& texture = graph_.textures()[std::size_t(handle.texture)];
    graph::TextureOptions options;
    options.auto_mips = texture.options.auto_mips;
    return graph_.create_texture(build.prefix() + name + "@" + pass.substr(build.prefix().size()),
                                 texture.desc, options);
}

void GraphBuilder::set_kind(const StepBuild& build, const PassSpec& spec, graph::Pass& pass) const {
    const auto cells = [&](const GridSpec& grid) {
        const auto [width, height] = grid_size(grid, build.params, width_, height_);
        return width * height;
    };
    if (const ComputeSpec* compute = spec.compute()) {
        pass.kind = graph::PassKind::compute;
        const DispatchSpec& dispatch = compute->dispatch;
        if (dispatch.kind == DispatchSpec::Kind::indirect) {
            pass.groups.indirect = build.buffers.at(dispatch.indirect);
        } else if (dispatch.kind == DispatchSpec::Kind::groups) {
            std::copy_n(dispatch.groups, 3, pass.groups.count.begin());
        } else {
            int width = width_, height = height_;
            if (!dispatch.over.empty()) {
                const auto& desc =
                    graph_.textures()[std::size_t(build.read_handle(dispatch.over).texture)].desc;
                width = desc.width;
                height = desc.height;
            }
            const GridSpec tiles{.kind = GridSpec::Kind::tile, .tile = dispatch.tile};
            std::tie(width, height) = grid_size(tiles, build.params, width, height);
            pass.groups.count = {width, height, 1};
        }
        return;
    }
    pass.blend = spec.draw()->blend;
    if (spec.draw()->instances) {
        pass.kind = graph::PassKind::instances;
        const InstanceSpec& instances = *spec.draw()->instances;
        pass.instances.primitive = instances.primitive == InstanceSpec::Primitive::points
                                       ? gpu::Primitive::points
                                       : gpu::Primitive::quads;
        pass.instances.covers = instances.covers;
        if (!instances.indirect.empty()) pass.instances.indirect = build.buffers.at(instances.indirect);
        else
            pass.instances.count =
                count_value(instances.count, build.params) * (instances.grid ? cells(*instances.grid) : 1);
    }
}

}  // namespace aftershade
