#include "framework/graph/rehearsal.h"

#include <algorithm>
#include <bit>
#include <deque>

#include "framework/gpu/buffer.h"
#include "framework/gpu/texture.h"

namespace aftershade::graph {
namespace {

/// Bytes that a storage block gets at most; shaders cannot read past its end.
constexpr std::size_t kMostBufferBytes = 4096;

int small_side(int side) {
    return std::has_single_bit(unsigned(side)) ? 4 : 3;
}

gpu::TextureDesc small(const gpu::TextureDesc& desc) {
    gpu::TextureDesc result = desc;
    result.width = small_side(desc.width);
    result.height = small_side(desc.height);
    result.layers = std::min(desc.layers, 2);
    result.mips = std::min(desc.mips, 2);
    return result;
}

/// The last of `count` for one beyond it.
std::optional<int> level_in(std::optional<int> level, int count) {
    return level ? std::optional(std::min(*level, count - 1)) : std::nullopt;
}

/// Textures and buffers for one draw, which never move.
class SmallMemory {
public:
    explicit SmallMemory(gpu::Context& context) : context_(context) {}

    gpu::Texture* texture(const PassShape::Texels& texels) {
        gpu::TextureDesc desc = texels.desc;
        desc.format = texels.memory;
        const gpu::Texture& memory = textures_.emplace_back(context_, desc, "rehearsal");
        if (texels.memory == texels.desc.format) return &textures_.back();
        return &textures_.emplace_back(memory, texels.desc.format, "rehearsal");
    }
    gpu::Buffer* buffer(std::size_t bytes) { return &buffers_.emplace_back(context_, bytes, "rehearsal"); }

private:
    gpu::Context& context_;
    std::deque<gpu::Texture> textures_;
    std::deque<gpu::Buffer> buffers_;
};

}  // namespace

PassShape shape_of(const FrameGraph& graph, const CompiledGraph& compiled, const Pass& pass) {
    const auto texture = [&](TextureHandle handle) -> const FrameGraph::Texture& {
        return graph.textures()[std::size_t(handle.texture)];
    };
    const auto texels = [&](TextureHandle handle) {
        const gpu::TextureDesc desc = small(texture(handle).desc);
        const int slot = compiled.slot_of_texture[std::size_t(handle.texture)];
        return PassShape::Texels{desc, slot < 0 ? desc.format : compiled.slots[std::size_t(slot)].format};
    };
    PassShape shape;
    shape.kind = pass.kind;
    shape.blend = pass.blend;
    shape.primitive = pass.instances.primitive;
    shape.first_target_unit = pass.first_target_unit;
    for (const Read& read : pass.reads) {
        const PassShape::Texels read_from = texels(read.texture);
        shape.reads.push_back(
            {read_from, read.binding, read.filter, read.wrap, level_in(read.level, read_from.desc.mips)});
    }
    for (const Target& target : pass.targets) {
        const FrameGraph::Texture& drawn = texture(target.texture);
        const PassShape::Texels to = texels(target.texture);
        shape.targets.push_back({to, level_in(target.level, to.desc.mips).value_or(0),
                                 level_in(target.layer, to.desc.layers).value_or(0),
                                 drawn.options.auto_mips && to.desc.mips > 1});
    }
    for (const ImageUse& use : pass.images)
        shape.images.push_back({texels(use.texture), use.binding, use.access});
    for (const BufferUse& use : pass.buffers)
        shape.buffers.push_back(
            {std::min(graph.buffers()[std::size_t(use.buffer.buffer)].desc.bytes, kMostBufferBytes),
             use.binding});
    for (const UniformBlock& block : pass.uniforms)
        shape.uniforms.push_back({block.bytes.size(), block.binding});
    return shape;
}

void rehearse(gpu::Context& context, const gpu::Program& program, const PassShape& shape) {
    if (!runs_program(shape.kind)) return;
    SmallMemory memory(context);
    std::vector<gpu::SampledTexture> textures;
    for (const PassShape::Sampled& read : shape.reads)
        textures.push_back({memory.texture(read.texture), read.binding, read.filter, read.wrap, read.level});
    std::vector<gpu::ImageBinding> images;
    for (const PassShape::Image& image : shape.images)
        images.push_back({memory.texture(image.texture), image.binding, 0, image.access});
    std::vector<gpu::BufferBinding> uniforms, storage;
    for (const PassShape::Memory& block : shape.uniforms)
        uniforms.push_back({memory.buffer(block.bytes), block.binding});
    for (const PassShape::Memory& block : shape.buffers)
        storage.push_back({memory.buffer(block.bytes), block.binding});
    const gpu::Bindings bindings{textures, images, uniforms, storage};
    if (shape.kind == PassKind::compute) return gpu::dispatch(context, program, 1, 1, 1, bindings);

    std::vector<gpu::Target> targets;
    std::vector<gpu::Texture*> with_mips;
    for (const PassShape::Drawn& target : shape.targets) {
        gpu::Texture* const drawn = memory.texture(target.texture);
        targets.push_back({drawn, target.level, target.layer});
        if (target.fills_mips) with_mips.push_back(drawn);
    }
    if (shape.first_target_unit)
        gpu::dispatch_over(context, program, targets, *shape.first_target_unit, bindings);
    else if (shape.kind == PassKind::instances)
        gpu::draw_instances(context, program, targets, bindings, {shape.primitive, 1, nullptr}, shape.blend);
    else gpu::draw(context, program, targets, bindings, shape.blend);
    for (gpu::Texture* const texture : with_mips) texture->generate_mips();
}

void prime(gpu::Context& context, const FrameGraph& graph, const CompiledGraph& compiled) {
    if (!context.info().software) return;
    const gpu::NothingToDo scope(context);
    for (const int index : compiled.passes) {
        const Pass& pass = graph.pass(index);
        if (pass.program) rehearse(context, *pass.program, shape_of(graph, compiled, pass));
    }
}

}  // namespace aftershade::graph
