#include "framework/graph/executor.h"

#include <cassert>
#include <utility>

#include "framework/gpu/timer.h"

namespace aftershade::graph {

Executor::Executor(gpu::Context& context, FrameGraph graph)
    : context_(context), graph_(std::move(graph)), compiled_(graph_.compile()) {
    std::vector<std::string> labels(compiled_.slots.size());
    for (std::size_t i = 0; i < graph_.textures().size(); ++i) {
        const int slot = compiled_.slot_of_texture[i];
        if (slot < 0) continue;
        std::string& label = labels[std::size_t(slot)];
        label += (label.empty() ? "" : "|") + graph_.textures()[i].name;
    }
    for (std::size_t i = 0; i < compiled_.slots.size(); ++i)
        slots_.emplace_back(context, compiled_.slots[i], labels[i]);
    for (const int index : compiled_.passes) {
        for (const UniformBlock& block : graph_.pass(index).uniforms) {
            gpu::Buffer buffer(context, block.bytes.size(), graph_.pass(index).name + ".uniforms");
            buffer.write(block.bytes);
            uniforms_.emplace(std::pair(index, block.binding), std::move(buffer));
        }
    }
}

gpu::Texture* Executor::texture(TextureHandle handle) {
    const int slot = compiled_.slot_of_texture.at(std::size_t(handle.texture));
    return slot < 0 ? nullptr : &slots_[std::size_t(slot)];
}

void Executor::set_uniforms(int pass, int binding, std::vector<std::byte> bytes) {
    for (UniformBlock& block : graph_.pass(pass).uniforms) {
        if (block.binding != binding) continue;
        assert(block.bytes.size() == bytes.size());
        block.bytes = std::move(bytes);
        // A culled pass has no buffer.
        if (const auto buffer = uniforms_.find({pass, binding}); buffer != uniforms_.end())
            buffer->second.write(block.bytes);
        return;
    }
    assert(false && "the pass has no such uniform block");
}

void Executor::run_pass(int index) {
    const Pass& pass = graph_.pass(index);
    std::vector<gpu::SampledTexture> textures;
    for (const Read& read : pass.reads)
        textures.push_back({texture(read.texture), read.binding, read.filter, read.wrap});
    std::vector<gpu::BufferBinding> uniforms;
    for (const UniformBlock& block : pass.uniforms)
        uniforms.push_back({&uniforms_.at({index, block.binding}), block.binding});
    std::vector<const gpu::Texture*> targets;
    for (const TextureHandle target : graph_.targets(index)) targets.push_back(texture(target));
    gpu::Bindings bindings;
    bindings.textures = textures;
    bindings.uniforms = uniforms;
    gpu::draw(context_, *pass.program, targets, bindings);
}

std::vector<PassTime> Executor::run(bool timed, const PassObserver& observer) {
    std::vector<PassTime> times;
    gpu::Timer timer(context_);
    for (const int index : compiled_.passes) {
        if (timed) timer.start();
        run_pass(index);
        if (timed) times.push_back({graph_.pass(index).name, timer.stop_ms()});
        if (!observer) continue;
        for (const TextureHandle target : graph_.targets(index))
            observer(graph_.pass(index).name, graph_.textures()[std::size_t(target.texture)].name,
                     *texture(target));
    }
    return times;
}

}  // namespace aftershade::graph
