#include "framework/graph/sparse_clears.h"

#include <algorithm>
#include <array>
#include <utility>

namespace aftershade::graph {

SparseClears::SparseClears(gpu::Context& context, const FrameGraph& graph, const CompiledGraph& compiled,
                           std::vector<gpu::Texture>& slots, std::vector<gpu::Buffer>& buffer_slots)
    : context_(context) {
    const auto buffer = [&](BufferHandle handle) {
        return &buffer_slots[std::size_t(compiled.slot_of_buffer[std::size_t(handle.buffer)])];
    };
    for (const SparseTexture& sparse : compiled.sparse) {
        gpu::Texture& memory = slots[std::size_t(compiled.slot_of_texture[std::size_t(sparse.texture)])];
        Tracked tracked;
        tracked.texture = &sparse;
        for (const SparseTexture::Place& place : sparse.places) {
            const Pass& pass = graph.pass(place.pass);
            const Target& target = pass.targets[std::size_t(place.target)];
            const Wipe& wipe = *pass.wipes[std::size_t(place.target)];
            gpu::Buffer uniforms(context, wipe.uniforms.bytes.size(), pass.name + ".wipe");
            uniforms.write(wipe.uniforms.bytes);
            tracked.wipes.push_back({&wipe,
                                     std::move(uniforms),
                                     buffer(wipe.places.buffer),
                                     {&memory, target.level, target.layer},
                                     {pass.instances.primitive, pass.instances.count,
                                      pass.instances.indirect ? buffer(*pass.instances.indirect) : nullptr}});
        }
        tracked_.push_back(std::move(tracked));
    }
}

void SparseClears::begin(PassRange range) {
    for (Tracked& tracked : tracked_) {
        const int first = tracked.texture->first, last = tracked.texture->last;
        tracked.is_due = range.contains(first) && range.contains(last) && tracked.state == State::drawn_once;
        const bool meets = first <= last && (range.end < 0 || first < range.end) && last >= range.begin;
        if (meets && !tracked.is_due) tracked.state = State::unknown;
    }
}

void SparseClears::wipe_before(int pass) {
    for (Tracked& tracked : tracked_) {
        if (!tracked.is_due || tracked.texture->first != pass) continue;
        tracked.is_due = false;
        // Where a draw throws, nothing is known.
        tracked.state = State::unknown;
        for (const BoundWipe& bound : tracked.wipes) draw(bound);
        tracked.state = State::clear;
    }
}

void SparseClears::draw(const BoundWipe& bound) {
    const std::array<gpu::Target, 1> targets = {bound.target};
    const std::array<gpu::BufferBinding, 1> uniforms = {{{&bound.uniforms, bound.wipe->uniforms.binding}}};
    const std::array<gpu::BufferBinding, 1> storage = {{{bound.places, bound.wipe->places.binding}}};
    gpu::draw_instances(context_, *bound.wipe->program, targets, {.uniforms = uniforms, .storage = storage},
                        bound.instances);
}

bool SparseClears::is_clear(int texture) {
    const auto found =
        std::ranges::find(tracked_, texture, [](const Tracked& tracked) { return tracked.texture->texture; });
    if (found == tracked_.end()) return false;
    return std::exchange(found->state, State::drawn_once) == State::clear;
}

}  // namespace aftershade::graph
