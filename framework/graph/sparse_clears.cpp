#include "framework/graph/sparse_clears.h"

#include <algorithm>
#include <array>
#include <utility>

namespace aftershade::graph {
namespace {

/// The wipe whose buffer says, when a sparse texture is wiped, where a level of it will be drawn over: that
/// of the first pass that draws to the level. nullptr where a pass reads the level before that, or changes
/// the buffer.
const Wipe* next_draw(const FrameGraph& graph, const CompiledGraph& compiled, const SparseTexture& sparse,
                      const Target& level) {
    const auto wipe_of = [&](const Pass& pass) -> const Wipe* {
        for (std::size_t i = 0; i < pass.targets.size(); ++i) {
            const Target& target = pass.targets[i];
            if (target.texture.texture == sparse.texture && target.level == level.level &&
                target.layer == level.layer)
                return &*pass.wipes[i];
        }
        return nullptr;
    };
    const auto reads_it = [&](const Pass& pass) {
        return std::ranges::any_of(pass.reads,
                                   [&](const Read& read) {
                                       return read.texture.texture == sparse.texture &&
                                              (read.level < 0 || read.level == level.level);
                                   }) ||
               std::ranges::any_of(pass.images, [&](const ImageUse& use) {
                   return use.texture.texture == sparse.texture && use.level == level.level;
               });
    };
    const auto writes = [](const Pass& pass, const BufferHandle& buffer) {
        return std::ranges::any_of(pass.buffers, [&](const BufferUse& use) {
            return use.access != gpu::Access::read && use.buffer.buffer == buffer.buffer;
        });
    };
    const auto from_first = std::ranges::find(compiled.passes, sparse.first);
    for (auto at = from_first; at != compiled.passes.end(); ++at) {
        const Pass& pass = graph.pass(*at);
        const Wipe* const wipe = wipe_of(pass);
        if (!wipe) {
            if (reads_it(pass)) return nullptr;
            continue;
        }
        const auto changes = [&](int index) { return writes(graph.pass(index), wipe->places.buffer); };
        const bool is_known = wipe->next_places &&
                              std::any_of(compiled.passes.begin(), from_first, changes) &&
                              std::none_of(from_first, at, changes);
        return is_known ? wipe : nullptr;
    }
    return nullptr;
}

}  // namespace

SparseClears::SparseClears(gpu::Context& context, const FrameGraph& graph, const CompiledGraph& compiled,
                           std::vector<gpu::Texture>& slots, std::vector<gpu::Buffer>& buffer_slots)
    : context_(context) {
    const auto buffer = [&](BufferHandle handle) {
        return &buffer_slots[std::size_t(compiled.slot_of_buffer[std::size_t(handle.buffer)])];
    };
    for (const SparseTexture& sparse : compiled.sparse) {
        Tracked& tracked = tracked_.emplace_back();
        tracked.texture = &sparse;
        gpu::Texture& slot = slots[std::size_t(compiled.slot_of_texture[std::size_t(sparse.texture)])];
        tracked.slot = &slot;
        for (const SparseTexture::Place& place : sparse.places) {
            const Pass& pass = graph.pass(place.pass);
            const Target& target = pass.targets[std::size_t(place.target)];
            const Wipe& wipe = *pass.wipes[std::size_t(place.target)];
            gpu::Buffer uniforms(context, wipe.uniforms.bytes.size(), pass.name + ".wipe");
            uniforms.write(wipe.uniforms.bytes);
            const gpu::Buffer* const places = buffer(wipe.places.buffer);
            const gpu::Buffer* next_places = nullptr;
            std::optional<gpu::Buffer> no_places;
            if (wipe.next_places) {
                const Wipe* const next = next_draw(graph, compiled, sparse, target);
                // Of the same tiles.
                if (next && next->uniforms.bytes == wipe.uniforms.bytes)
                    next_places = buffer(next->places.buffer);
                else no_places.emplace(context, places->size(), pass.name + ".no places");
            }
            tracked.wipes.push_back({&wipe,
                                     place.pass,
                                     std::move(uniforms),
                                     places,
                                     next_places,
                                     std::move(no_places),
                                     {&slot, target.level, target.layer},
                                     {pass.instances.primitive, pass.instances.count,
                                      pass.instances.indirect ? buffer(*pass.instances.indirect) : nullptr}});
        }
    }
}

SparseClears::Memory& SparseClears::memory_of(Tracked& tracked) {
    const unsigned int handle = tracked.slot->handle();
    const auto found = std::ranges::find(tracked.memories, handle, &Memory::handle);
    if (found != tracked.memories.end()) return *found;
    Memory& memory = tracked.memories.emplace_back();
    memory.handle = handle;
    for (const BoundWipe& bound : tracked.wipes) {
        std::optional<gpu::Buffer> instances;
        if (bound.instances.indirect)
            instances.emplace(context_, bound.instances.indirect->size(), "instances drawn");
        memory.drawn.push_back({{context_, bound.places->size(), "places drawn"}, std::move(instances)});
    }
    return memory;
}

void SparseClears::begin(PassRange range) {
    for (Tracked& tracked : tracked_) {
        const int first = tracked.texture->first, last = tracked.texture->last;
        tracked.is_due = range.contains(first) && range.contains(last);
        tracked.is_fresh = false;
        const bool meets = (range.end < 0 || first < range.end) && last >= range.begin;
        if (meets && !tracked.is_due) memory_of(tracked).is_known = false;
    }
}

bool SparseClears::wipe(int texture) {
    const auto found =
        std::ranges::find(tracked_, texture, [](const Tracked& tracked) { return tracked.texture->texture; });
    if (found == tracked_.end() || !std::exchange(found->is_due, false)) return false;
    Memory& memory = memory_of(*found);
    // Where a draw throws, nothing is known.
    const bool wipes = std::exchange(memory.is_known, false);
    if (wipes)
        for (std::size_t i = 0; i < found->wipes.size(); ++i) draw(found->wipes[i], memory.drawn[i]);
    found->is_fresh = true;
    return wipes;
}

void SparseClears::note_places(int pass) {
    for (Tracked& tracked : tracked_)
        for (std::size_t i = 0; i < tracked.wipes.size(); ++i) {
            const BoundWipe& bound = tracked.wipes[i];
            if (bound.pass != pass) continue;
            Memory& memory = memory_of(tracked);
            memory.drawn[i].places.copy_from(*bound.places);
            if (memory.drawn[i].instances) memory.drawn[i].instances->copy_from(*bound.instances.indirect);
            if (i + 1 == tracked.wipes.size()) memory.is_known = std::exchange(tracked.is_fresh, false);
        }
}

void SparseClears::forget() {
    for (Tracked& tracked : tracked_)
        for (Memory& memory : tracked.memories) memory.is_known = false;
}

void SparseClears::draw(const BoundWipe& bound, const Drawn& drawn) {
    const std::array<gpu::Target, 1> targets = {bound.target};
    const std::array<gpu::BufferBinding, 1> uniforms = {{{&bound.uniforms, bound.wipe->uniforms.binding}}};
    std::vector<gpu::BufferBinding> storage = {{&drawn.places, bound.wipe->places.binding}};
    if (bound.wipe->next_places)
        storage.push_back(
            {bound.no_places ? &*bound.no_places : bound.next_places, *bound.wipe->next_places});
    gpu::InstanceRange instances = bound.instances;
    if (drawn.instances) instances.indirect = &*drawn.instances;
    const std::shared_ptr<const gpu::Program> program = bound.wipe->program();
    gpu::draw_instances(context_, *program, targets, {.uniforms = uniforms, .storage = storage}, instances);
}

}  // namespace aftershade::graph
