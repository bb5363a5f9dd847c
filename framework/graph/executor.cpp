#include "framework/graph/executor.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "framework/base/memory_limit.h"
#include "framework/gpu/timer.h"

namespace aftershade::graph {
namespace {

/// The names of all that lie in each slot: "a|b".
template <typename Node>
std::vector<std::string> slot_labels(const std::vector<Node>& nodes, const std::vector<int>& slot_of,
                                     std::size_t slots) {
    std::vector<std::string> labels(slots);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (slot_of[i] < 0) continue;
        std::string& label = labels[std::size_t(slot_of[i])];
        label += (label.empty() ? "" : "|") + nodes[i].name;
    }
    return labels;
}

template <typename Memory>
Memory* in_slot(std::vector<Memory>& slots, const std::vector<int>& slot_of, int index) {
    const int slot = slot_of.at(std::size_t(index));
    return slot < 0 ? nullptr : &slots[std::size_t(slot)];
}

}  // namespace

std::vector<PassTime> measured(std::vector<PendingTime> times) {
    std::vector<PassTime> result;
    result.reserve(times.size());
    for (PendingTime& time : times) result.push_back({std::move(time.pass), time.duration.ms()});
    return result;
}

Executor::Executor(gpu::Context& context, FrameGraph graph, bool shares_memory)
    : context_(context), graph_(std::move(graph)), compiled_(graph_.compile(shares_memory)), timer_(context) {
    for (const int index : compiled_.passes) {
        const Pass& pass = graph_.pass(index);
        if (runs_program(pass.kind) && !pass.program)
            throw GraphError(fmt::format("pass '{}' has no program", pass.name));
    }
    allocate();
    find_histories();
    clear_history();
    bind_clears();
    for (const int index : compiled_.passes) bound_.push_back(bind(index));
}

void Executor::allocate() {
    // Mesa does not check every allocation of its own.
    constexpr std::uint64_t kForMesa = 64ull * 1024 * 1024;
    require_address_space(compiled_.bytes + kForMesa, "the memory of a frame's passes");
    const auto labels = slot_labels(graph_.textures(), compiled_.slot_of_texture, compiled_.slots.size());
    // Pointers to slots are kept: they must not move.
    slots_.reserve(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i)
        slots_.emplace_back(context_, compiled_.slots[i], labels[i]);
    for (std::size_t i = 0; i < graph_.textures().size(); ++i) {
        const int slot = compiled_.slot_of_texture[i];
        const gpu::TextureFormat format = graph_.textures()[i].desc.format;
        if (slot < 0 || format == compiled_.slots[std::size_t(slot)].format) continue;
        views_.try_emplace({slot, format}, slots_[std::size_t(slot)], format, labels[std::size_t(slot)]);
    }
    const auto buffer_labels =
        slot_labels(graph_.buffers(), compiled_.slot_of_buffer, compiled_.buffer_slots.size());
    buffer_slots_.reserve(buffer_labels.size());
    for (std::size_t i = 0; i < buffer_labels.size(); ++i)
        buffer_slots_.emplace_back(context_, compiled_.buffer_slots[i].bytes, buffer_labels[i]);
    for (const int index : compiled_.passes) {
        for (const UniformBlock& block : graph_.pass(index).uniforms) {
            gpu::Buffer buffer(context_, block.bytes.size(), graph_.pass(index).name + ".uniforms");
            buffer.write(block.bytes);
            uniforms_.emplace(std::pair(index, block.binding), std::move(buffer));
        }
    }
}

void Executor::find_histories() {
    std::vector<int> textures(graph_.textures().size(), -1), buffers(graph_.buffers().size(), -1);
    for (const int index : compiled_.passes) {
        const Pass& pass = graph_.pass(index);
        for (const Target& target : pass.targets) textures[std::size_t(target.texture.texture)] = index;
        for (const ImageUse& use : pass.images)
            if (use.access != gpu::Access::read) textures[std::size_t(use.texture.texture)] = index;
        for (const BufferUse& use : pass.buffers)
            if (use.access != gpu::Access::read) buffers[std::size_t(use.buffer.buffer)] = index;
    }
    const auto find = [](const auto& nodes, const auto& slot_of, auto& slots, const std::vector<int>& written,
                         auto& histories) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const int current = nodes[i].previous_of;
            if (current < 0 || slot_of[i] < 0) continue;
            histories.push_back(
                {&nodes[std::size_t(current)].name, in_slot(slots, slot_of, int(i)),
                 written[std::size_t(current)] >= 0 ? in_slot(slots, slot_of, current) : nullptr,
                 written[std::size_t(current)]});
        }
    };
    find(graph_.textures(), compiled_.slot_of_texture, slots_, textures, texture_histories_);
    find(graph_.buffers(), compiled_.slot_of_buffer, buffer_slots_, buffers, buffer_histories_);
}

void Executor::bind_clears() {
    clears_.resize(compiled_.passes.size() + 1);
    const bool are_zero = context_.zeroes_new_textures();
    for (std::size_t i = 0; i < graph_.textures().size(); ++i) {
        const int position = compiled_.texture_cleared_before[i];
        if (position < 0) continue;
        const std::array<double, 4>& value = *graph_.textures()[i].options.clear;
        const int slot = compiled_.slot_of_texture[i];
        const bool is_there = are_zero && value == std::array<double, 4>{} &&
                              compiled_.first_in_slot[std::size_t(slot)] == int(i);
        clears_[std::size_t(position)].textures.push_back({texture({int(i)}), value, is_there});
    }
    for (std::size_t i = 0; i < graph_.buffers().size(); ++i) {
        const int position = compiled_.buffer_cleared_before[i];
        if (position < 0) continue;
        clears_[std::size_t(position)].buffers.push_back(
            {in_slot(buffer_slots_, compiled_.slot_of_buffer, int(i)), *graph_.buffers()[i].clear});
    }
}

Executor::BoundPass Executor::bind(int index) {
    const Pass& pass = graph_.pass(index);
    BoundPass bound;
    bound.pass = &pass;
    const auto writes = [&](TextureHandle handle) {
        const FrameGraph::Texture& node = graph_.textures()[std::size_t(handle.texture)];
        gpu::Texture* const written = texture(handle);
        bound.observed.push_back({&node.name, written});
        if (node.options.auto_mips && node.desc.mips > 1 &&
            std::find(bound.mips.begin(), bound.mips.end(), written) == bound.mips.end())
            bound.mips.push_back(written);
    };
    for (const Read& read : pass.reads)
        bound.textures.push_back({texture(read.texture), read.binding, read.filter, read.wrap, read.level});
    for (const Target& target : pass.targets) {
        bound.targets.push_back(
            {texture(target.texture), target.level.value_or(0), target.layer.value_or(0)});
        bound.clear_targets.push_back(texture(target.texture));
        writes(target.texture);
    }
    for (const ImageUse& use : pass.images) {
        bound.images.push_back({texture(use.texture), use.binding, use.level, use.access});
        if (use.access != gpu::Access::read) writes(use.texture);
    }
    for (const BufferUse& use : pass.buffers) bound.storage.push_back({buffer(use.buffer), use.binding});
    for (const UniformBlock& block : pass.uniforms)
        bound.uniforms.push_back({&uniforms_.at({index, block.binding}), block.binding});
    bound.instances = {pass.instances.primitive, pass.instances.count,
                       pass.instances.indirect ? buffer(*pass.instances.indirect) : nullptr};
    bound.groups = pass.groups.indirect ? buffer(*pass.groups.indirect) : nullptr;
    return bound;
}

gpu::Texture* Executor::texture(TextureHandle handle) {
    const int slot = compiled_.slot_of_texture.at(std::size_t(handle.texture));
    if (slot < 0) return nullptr;
    const auto view = views_.find({slot, graph_.textures()[std::size_t(handle.texture)].desc.format});
    return view == views_.end() ? &slots_[std::size_t(slot)] : &view->second;
}

gpu::Buffer* Executor::buffer(BufferHandle handle) {
    return in_slot(buffer_slots_, compiled_.slot_of_buffer, handle.buffer);
}

void Executor::set_uniforms(int pass, int binding, std::vector<std::byte> bytes) {
    for (UniformBlock& block : graph_.pass(pass).uniforms) {
        if (block.binding != binding) continue;
        assert(block.bytes.size() == bytes.size());
        if (block.bytes == bytes) return;
        block.bytes = std::move(bytes);
        // A culled pass has no buffer.
        if (const auto buffer = uniforms_.find({pass, binding}); buffer != uniforms_.end())
            buffer->second.write(block.bytes);
        return;
    }
    assert(false && "the pass has no such uniform block");
}

void Executor::run_clears(Clears& clears) {
    for (Clears::OfTexture& clear : clears.textures)
        if (!std::exchange(clear.is_there, false)) clear.texture->clear_to(clear.value);
    for (const auto& [buffer, words] : clears.buffers) {
        const auto bytes = std::as_bytes(words);
        if (bytes.size() < buffer->size()) buffer->clear(0);
        buffer->write(bytes);
    }
}

/// Passes run whose memory others were to clear.
void Executor::forget_new_memory() {
    for (Clears& clears : clears_)
        for (Clears::OfTexture& clear : clears.textures) clear.is_there = false;
}

void Executor::run_program(const BoundPass& bound) {
    const Pass& pass = *bound.pass;
    const gpu::Bindings bindings{.textures = bound.textures,
                                 .images = bound.images,
                                 .uniforms = bound.uniforms,
                                 .storage = bound.storage};
    if (pass.first_target_unit)
        return gpu::dispatch_over(context_, *pass.program, bound.targets, *pass.first_target_unit, bindings);
    switch (pass.kind) {
        case PassKind::draw: gpu::draw(context_, *pass.program, bound.targets, bindings, pass.blend); break;
        case PassKind::instances:
            gpu::draw_instances(context_, *pass.program, bound.targets, bindings, bound.instances,
                                pass.blend);
            break;
        case PassKind::compute:
            if (bound.groups) {
                gpu::dispatch_indirect(context_, *pass.program, *bound.groups, bindings);
            } else {
                const auto [x, y, z] = pass.groups.count;
                gpu::dispatch(context_, *pass.program, x, y, z, bindings);
            }
            break;
        case PassKind::copy:
        case PassKind::clear: break;
    }
}

void Executor::run_pass(const BoundPass& bound) {
    const Pass& pass = *bound.pass;
    switch (pass.kind) {
        case PassKind::draw:
        case PassKind::instances:
        case PassKind::compute: run_program(bound); break;
        case PassKind::copy: {
            const gpu::Texture &from = *bound.textures.front().texture, &to = *bound.targets.front().texture;
            if (&from != &to) gpu::copy(context_, from, to);
            break;
        }
        case PassKind::clear:
            for (std::size_t i = 0; i < bound.clear_targets.size(); ++i)
                bound.clear_targets[i]->clear_to(pass.clear_value, pass.targets[i].level,
                                                 pass.targets[i].layer);
            break;
    }
    for (gpu::Texture* const texture : bound.mips) texture->generate_mips();
}

std::vector<PendingTime> Executor::issue(bool timed, const PassObserver& observer, PassRange range) {
    const auto for_written = [&](const auto& act) {
        for (auto& history : texture_histories_)
            if (range.contains(history.written_by)) act(history);
        for (auto& history : buffer_histories_)
            if (range.contains(history.written_by)) act(history);
    };
    for_written([](auto& history) { history.advance(); });
    if (range.begin > 0) forget_new_memory();
    std::vector<PendingTime> times;
    if (timed) times.reserve(bound_.size());
    for (std::size_t i = 0; i < bound_.size(); ++i) {
        if (!range.contains(compiled_.passes[i])) continue;
        if (hooks_.begins) hooks_.begins(bound_[i].pass->name);
        if (timed) timer_.start();
        run_clears(clears_[i]);
        run_pass(bound_[i]);
        if (timed) times.push_back({bound_[i].pass->name, timer_.stop()});
        if (timed && hooks_.waits) times.back().duration.ms();
        if (observer)
            for (const BoundPass::Observed& written : bound_[i].observed)
                observer(bound_[i].pass->name, *written.name, *written.texture);
        if (hooks_.ended) hooks_.ended(bound_[i].pass->name);
    }
    if (range.end < 0) run_clears(clears_.back());
    for_written([](auto& history) { history.current_is_newer = history.current != nullptr; });
    return times;
}

void Executor::set_hooks(PassHooks hooks) {
    hooks_ = std::move(hooks);
    if (!hooks_.storage.buffer) return;
    for (BoundPass& bound : bound_)
        if (bound.pass->program) bound.storage.push_back(hooks_.storage);
}

Executor::History Executor::history() {
    History result;
    for (const auto& history : texture_histories_) result.textures.emplace(*history.name, history.newest());
    for (const auto& history : buffer_histories_) result.buffers.emplace(*history.name, history.newest());
    return result;
}

void Executor::clear_history() {
    for (auto& history : texture_histories_) {
        history.current_is_newer = false;
        history.previous->clear_to({0, 0, 0, 0});
    }
    for (auto& history : buffer_histories_) {
        history.current_is_newer = false;
        history.previous->clear(0);
    }
}

std::vector<std::string> Executor::take_history_from(Executor& other) {
    assert(&context_ == &other.context_ && this != &other);
    std::vector<std::string> missing;
    const auto take = [&](auto& mine, auto& theirs, const auto& same) {
        for (auto& history : mine) {
            const auto found = std::find_if(theirs.begin(), theirs.end(), [&](const auto& candidate) {
                return *candidate.name == *history.name && same(*candidate.previous, *history.previous);
            });
            if (found == theirs.end()) {
                missing.push_back(*history.name);
                continue;
            }
            history.current_is_newer = false;
            std::swap(*history.previous, *found->newest());
        }
    };
    take(texture_histories_, other.texture_histories_,
         [](const gpu::Texture& a, const gpu::Texture& b) { return a.desc() == b.desc(); });
    take(buffer_histories_, other.buffer_histories_,
         [](const gpu::Buffer& a, const gpu::Buffer& b) { return a.size() == b.size(); });
    return missing;
}

}  // namespace aftershade::graph
