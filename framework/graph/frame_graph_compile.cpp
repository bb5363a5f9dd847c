// Culling by version, and sharing of memory between lifetimes that do not meet.
#include <algorithm>
#include <functional>
#include <optional>
#include <span>

#include "framework/graph/frame_graph.h"
#include "framework/graph/frame_graph_internal.h"

namespace aftershade::graph {

PassUses uses_of(const FrameGraph& graph, int pass_index) {
    const Pass& pass = graph.pass(pass_index);
    const Written& written = graph.written(pass_index);
    const int buffers = int(graph.textures().size());
    PassUses uses;
    if (graph.is_fused_away(pass_index)) return uses;
    const auto need = [&](TextureHandle h) { uses.needs.push_back({h.texture, h.version}); };
    const auto need_buffer = [&](BufferHandle h) { uses.needs.push_back({buffers + h.buffer, h.version}); };
    for (const Read& read : pass.reads) need(read.texture);
    for (std::size_t i = 0; i < pass.targets.size(); ++i) {
        if (!graph.overwrites(pass, pass.targets[i])) need(pass.targets[i].texture);
        uses.makes.push_back({written.targets[i].texture, written.targets[i].version});
    }
    for (std::size_t i = 0; i < pass.images.size(); ++i) {
        need(pass.images[i].texture);
        if (pass.images[i].access == gpu::Access::read) continue;
        uses.makes.push_back({written.images[i].texture, written.images[i].version});
    }
    for (std::size_t i = 0; i < pass.buffers.size(); ++i) {
        need_buffer(pass.buffers[i].buffer);
        if (pass.buffers[i].access == gpu::Access::read) continue;
        uses.makes.push_back({buffers + written.buffers[i].buffer, written.buffers[i].version});
    }
    for (const auto& indirect : {pass.instances.indirect, pass.groups.indirect})
        if (indirect) need_buffer(*indirect);
    return uses;
}

namespace {

/// What a texture and a buffer have in common here.
struct Resource {
    bool kept = false;
    bool alone = false;  ///< histories, and imports that stay, share their memory with nothing
    bool is_given_each_frame = false;
    bool is_history = false;
    bool cleared = false;
    int previous_of = -1;  ///< a resource
    int version = 0;       ///< the last one
};

/// Positions of the first and the last pass that touch a resource.
struct Lifetime {
    int first = 0;
    int last = 0;
};

class Compiler {
public:
    Compiler(const FrameGraph& graph, bool shares_memory)
        : graph_(graph), shares_memory_(shares_memory), buffers_(graph.textures().size()) {
        for (const FrameGraph::Texture& t : graph.textures())
            resources_.push_back({t.kept, t.imported && !t.is_given_each_frame,
                                  t.imported && t.is_given_each_frame, false, t.options.clear.has_value(),
                                  t.previous_of, t.version});
        for (const FrameGraph::Buffer& b : graph.buffers())
            resources_.push_back({b.kept, b.imported, false, false, b.clear.has_value(),
                                  b.previous_of < 0 ? -1 : b.previous_of + int(buffers_), b.version});
        for (Resource& resource : resources_) {
            if (resource.previous_of < 0) continue;
            Resource& current = resources_[std::size_t(resource.previous_of)];
            resource.alone = current.alone = resource.is_history = current.is_history = true;
        }
        for (int i = 0; i < graph.pass_count(); ++i) uses_.push_back(uses_of(graph, i));
    }

    CompiledGraph run() {
        cull();
        find_lifetimes();
        find_copies_in_place();
        const auto bytes_of_buffer = [](const BufferDesc& desc) { return std::uint64_t(desc.bytes); };
        assign(graph_.textures(), 0, compiled_.slots, compiled_.slot_of_texture, gpu::byte_size,
               gpu::may_share_memory, original_of_);
        find_first_in_slots();
        set_formats_for_copies();
        assign(graph_.buffers(), buffers_, compiled_.buffer_slots, compiled_.slot_of_buffer, bytes_of_buffer,
               std::equal_to(), std::vector<int>(graph_.buffers().size(), -1));
        for (std::size_t i = 0; i < resources_.size(); ++i) {
            auto& cleared = i < buffers_ ? compiled_.texture_cleared_before : compiled_.buffer_cleared_before;
            const bool is_seen = resources_[i].cleared && lifetimes_[i] && needed_[i][0];
            cleared.push_back(is_seen ? first_use_[i] : -1);
        }
        return std::move(compiled_);
    }

private:
    bool is_needed(const Version& v) const {
        return needed_[std::size_t(v.resource)][std::size_t(v.version)];
    }
    void need(const Version& v) { needed_[std::size_t(v.resource)][std::size_t(v.version)] = true; }

    /// Passes from the last to the first: one matters if a later one needs a version that it makes.
    void sweep() {
        for (std::size_t i = uses_.size(); i-- > 0;) {
            const auto& makes = uses_[i].makes;
            if (std::none_of(makes.begin(), makes.end(), [&](const Version& v) { return is_needed(v); }))
                continue;
            runs_[i] = true;
            for (const Version& version : uses_[i].needs) need(version);
        }
    }

    void cull() {
        runs_.assign(uses_.size(), false);
        for (const Resource& resource : resources_) {
            needed_.emplace_back(std::size_t(resource.version) + 1);
            if (resource.kept) needed_.back().back() = true;
        }
        // Reading a history's `previous` makes its `current` matter, whose passes may read other histories.
        for (bool again = true; again;) {
            again = false;
            sweep();
            for (const Resource& previous : resources_) {
                const auto index = std::size_t(&previous - resources_.data());
                if (previous.previous_of < 0 || !needed_[index][1]) continue;
                const Version current{previous.previous_of,
                                      resources_[std::size_t(previous.previous_of)].version};
                if (is_needed(current)) continue;
                need(current);
                again = true;
            }
        }
        for (std::size_t i = 0; i < runs_.size(); ++i)
            if (runs_[i]) compiled_.passes.push_back(int(i));
    }

    void find_first_in_slots() {
        compiled_.first_in_slot.assign(compiled_.slots.size(), -1);
        for (std::size_t i = 0; i < buffers_; ++i) {
            if (compiled_.slot_of_texture[i] < 0) continue;
            int& first = compiled_.first_in_slot[std::size_t(compiled_.slot_of_texture[i])];
            if (first < 0 || lifetimes_[i]->first < lifetimes_[std::size_t(first)]->first) first = int(i);
        }
    }

    /// Software GL copies memory only between textures of one format, and a view has that of its slot:
    /// between others it draws, which takes three times as long.
    void set_formats_for_copies() {
        for (const int index : compiled_.passes) {
            const Pass& pass = graph_.pass(index);
            if (pass.kind != PassKind::copy) continue;
            for (const TextureHandle handle : {pass.reads.front().texture, pass.targets.front().texture}) {
                const auto texture = std::size_t(handle.texture);
                compiled_.slots[std::size_t(compiled_.slot_of_texture[texture])].format =
                    graph_.textures()[texture].desc.format;
            }
        }
    }

    void find_lifetimes() {
        lifetimes_.resize(resources_.size());
        const int end = int(compiled_.passes.size());
        for (int position = 0; position < end; ++position) {
            const PassUses& uses = uses_[std::size_t(compiled_.passes[std::size_t(position)])];
            for (const auto* versions : {&uses.needs, &uses.makes})
                for (const Version& version : *versions) {
                    std::optional<Lifetime>& life = lifetimes_[std::size_t(version.resource)];
                    if (!life) life = {position, position};
                    life->last = position;
                }
        }
        for (std::size_t i = 0; i < resources_.size(); ++i) {
            std::optional<Lifetime>& life = lifetimes_[i];
            last_use_.push_back(life ? life->last : -1);
            if (resources_[i].kept) life = {life ? life->first : end, end};
            first_use_.push_back(life ? life->first : -1);
            if (life && resources_[i].is_given_each_frame) life->first = -1;
            if (life && (resources_[i].alone || !shares_memory_)) life = {-1, end};
        }
    }

    /// Whether a copy of `from` can leave everything where it is: nothing needs `from` after it, and each
    /// frame makes it again or is given it again.
    bool gives_up(const TextureHandle& from, int position) const {
        const auto index = std::size_t(from.texture);
        const FrameGraph::Texture& texture = graph_.textures()[index];
        const bool comes_again = texture.imported ? texture.is_given_each_frame : texture.previous_of < 0;
        return shares_memory_ && comes_again && !texture.kept && !texture.options.clear &&
               !resources_[index].is_history && last_use_[index] == position;
    }

    void find_copies_in_place() {
        original_of_.assign(buffers_, -1);
        for (int position = 0; position < int(compiled_.passes.size()); ++position) {
            const Pass& pass = graph_.pass(compiled_.passes[std::size_t(position)]);
            if (pass.kind != PassKind::copy) continue;
            const TextureHandle from = pass.reads.front().texture, to = pass.targets.front().texture;
            const FrameGraph::Texture& copy = graph_.textures()[std::size_t(to.texture)];
            const bool begins = first_use_[std::size_t(to.texture)] == position && !copy.imported &&
                                !copy.options.clear && !resources_[std::size_t(to.texture)].is_history;
            if (begins && gives_up(from, position) &&
                copy.desc == graph_.textures()[std::size_t(from.texture)].desc)
                original_of_[std::size_t(to.texture)] = from.texture;
        }
    }

    /// By first use, each into the first slot that suits its description and is free by then: as many slots
    /// as live at once, since the lifetimes are intervals. What has an original goes to its slot.
    template <typename Node, typename Desc, typename ByteSize, typename Suits>
    void assign(const std::vector<Node>& nodes, std::size_t offset, std::vector<Desc>& slots,
                std::vector<int>& slot_of, ByteSize byte_size, Suits suits,
                const std::vector<int>& original_of) {
        slot_of.assign(nodes.size(), -1);
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (lifetimes_[offset + i]) order.push_back(i);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return lifetimes_[offset + a]->first < lifetimes_[offset + b]->first;
        });
        std::vector<int> busy_until;
        for (const std::size_t i : order) {
            const Lifetime life = *lifetimes_[offset + i];
            const Desc& desc = nodes[i].desc;
            std::size_t slot = 0;
            const auto is_free = [&] { return suits(slots[slot], desc) && busy_until[slot] < life.first; };
            if (original_of[i] >= 0) slot = std::size_t(slot_of[std::size_t(original_of[i])]);
            else
                while (slot < slots.size() && !is_free()) ++slot;
            if (slot == slots.size()) {
                slots.push_back(desc);
                busy_until.push_back(0);
                compiled_.bytes += byte_size(desc);
            }
            busy_until[slot] = std::max(busy_until[slot], life.last);
            slot_of[i] = int(slot);
            compiled_.bytes_unaliased += byte_size(desc);
        }
    }

    const FrameGraph& graph_;
    bool shares_memory_;
    std::size_t buffers_;  // where they begin among the resources
    std::vector<Resource> resources_;
    std::vector<PassUses> uses_;
    std::vector<std::vector<bool>> needed_;  // by resource and version
    std::vector<bool> runs_;
    std::vector<std::optional<Lifetime>> lifetimes_;
    std::vector<int> first_use_, last_use_;  // positions; -1 for what is not used
    std::vector<int> original_of_;  // per texture: whose memory a copy in place keeps; -1: no such one
    CompiledGraph compiled_;
};

}  // namespace

CompiledGraph FrameGraph::compile(bool shares_memory) const {
    return Compiler(*this, shares_memory).run();
}

}  // namespace aftershade::graph
