#include "framework/graph/fusion.h"

#include <algorithm>
#include <map>
#include <utility>

#include "framework/graph/frame_graph_internal.h"

namespace aftershade::graph {
namespace {

/// A texture holds what a shader computed, to the bit.
bool keeps_bits(gpu::TextureFormat format) {
    using enum gpu::TextureFormat;
    switch (format) {
        case r32f:
        case rg32f:
        case rgba32f:
        case r32ui:
        case rg32ui:
        case rgba32ui:
        case r32i: return true;
        default: return false;
    }
}

using Key = std::pair<int, int>;  // a version

class Finder {
public:
    Finder(const FrameGraph& graph, const CompiledGraph& compiled, const FusionOptions& options)
        : graph_(graph), compiled_(compiled), options_(options) {
        for (const int pass : compiled.passes) {
            const PassUses& uses = uses_.emplace(pass, uses_of(graph, pass)).first->second;
            for (const Version& version : uses.needs) users_[key(version)].push_back(pass);
            for (const Version& version : uses.makes) makers_[key(version)] = pass;
        }
    }

    std::vector<Fusion> find() {
        for (const int pass : compiled_.passes) {
            const Fusing fusing = graph_.pass(pass).fusing;
            if (fusing == Fusing::never) continue;
            if (fusing == Fusing::follows && join(pass)) continue;
            group_of_[pass] = int(groups_.size());
            groups_.push_back({pass});
        }
        std::vector<Fusion> found;
        for (const std::vector<int>& group : groups_)
            if (group.size() > 1) found.push_back({group, targets_of(group)});
        return found;
    }

private:
    static Key key(const Version& version) { return {version.resource, version.version}; }
    static Key key(TextureHandle handle) { return {handle.texture, handle.version}; }

    /// Its program can be a part, and its targets have one level and layer.
    bool is_sound(int index) const {
        const Pass& pass = graph_.pass(index);
        return options_.blocks(index) <= options_.limits.blocks &&
               std::ranges::all_of(pass.targets, [&](const Target& target) {
                   const gpu::TextureDesc& desc = desc_of(target.texture);
                   return desc.mips == 1 && desc.layers == 1;
               });
    }

    /// The group that makes the last of what the pass reads by the pixel takes the pass, where it can.
    bool join(int pass) {
        int maker = -1;
        for (const Read& read : graph_.pass(pass).reads)
            if (const auto found = makers_.find(key(read.texture)); read.is_pixel && found != makers_.end())
                maker = std::max(maker, found->second);
        const auto group = group_of_.find(maker);
        if (group == group_of_.end() || !may_join(groups_[std::size_t(group->second)], pass)) return false;
        const int index = group->second;
        groups_[std::size_t(index)].push_back(pass);
        group_of_[pass] = index;
        return true;
    }

    bool may_join(const std::vector<int>& group, int pass) const {
        if ((group.front() < options_.divide_at) != (pass < options_.divide_at)) return false;
        const gpu::TextureDesc& first = desc_of(graph_.pass(group.front()).targets.front().texture);
        const gpu::TextureDesc& own = desc_of(graph_.pass(pass).targets.front().texture);
        if (first.width != own.width || first.height != own.height) return false;
        std::vector<int> joined = group;
        joined.push_back(pass);
        return takes_pixels(group, pass) && may_wait(group, pass) && is_sound(group.front()) &&
               is_sound(pass) && fits(joined);
    }

    /// Of what the group makes, the pass needs its own pixel alone, as a texture would hold it.
    bool takes_pixels(const std::vector<int>& group, int pass) const {
        return std::ranges::all_of(graph_.pass(pass).reads, [&](const Read& read) {
            return !is_made_by(group, key(read.texture)) ||
                   (read.is_pixel && keeps_bits(desc_of(read.texture).format));
        });
    }

    /// Nothing but the group and the pass needs the group's results before the pass, and what the group reads
    /// stays until then.
    bool may_wait(const std::vector<int>& group, int pass) const {
        for (const int member : group) {
            for (const Version& made : uses_.at(member).makes)
                for (const int user : users_of(key(made)))
                    if (user < pass && !contains(group, user)) return false;
            for (const Version& needed : uses_.at(member).needs)
                for (const auto& [version, maker] : makers_)
                    if (version.first == needed.resource && version.second > needed.version &&
                        maker > member && maker <= pass)
                        return false;
        }
        return true;
    }

    bool fits(const std::vector<int>& group) const {
        int samplers = 0, buffers = 0, blocks = 0;
        for (const int member : group) {
            const Pass& pass = graph_.pass(member);
            for (const Read& read : pass.reads) samplers += is_made_by(group, key(read.texture)) ? 0 : 1;
            buffers += int(pass.buffers.size());
            blocks += options_.blocks(member);
        }
        const FusionLimits& limits = options_.limits;
        return int(group.size()) <= limits.parts && samplers <= limits.samplers &&
               buffers <= limits.buffers && blocks <= limits.blocks &&
               int(targets_of(group).size()) <= limits.targets;
    }

    /// What others than the group need of what it makes.
    std::vector<TextureHandle> targets_of(const std::vector<int>& group) const {
        std::vector<TextureHandle> targets;
        for (const int member : group)
            for (const TextureHandle& made : graph_.written(member).targets)
                if (is_needed_outside(group, made)) targets.push_back(made);
        return targets;
    }

    bool is_needed_outside(const std::vector<int>& group, TextureHandle made) const {
        const FrameGraph::Texture& texture = graph_.textures()[std::size_t(made.texture)];
        const bool is_last = texture.version == made.version;
        const bool is_history = std::ranges::any_of(
            graph_.textures(), [&](const auto& other) { return other.previous_of == made.texture; });
        if (is_last && (texture.kept || is_history)) return true;
        return std::ranges::any_of(users_of(key(made)), [&](int user) { return !contains(group, user); });
    }

    bool is_made_by(const std::vector<int>& group, Key version) const {
        const auto maker = makers_.find(version);
        return maker != makers_.end() && contains(group, maker->second);
    }
    static bool contains(const std::vector<int>& group, int pass) {
        return std::ranges::find(group, pass) != group.end();
    }
    const std::vector<int>& users_of(Key version) const {
        static const std::vector<int> none;
        const auto found = users_.find(version);
        return found == users_.end() ? none : found->second;
    }
    const gpu::TextureDesc& desc_of(TextureHandle handle) const {
        return graph_.textures()[std::size_t(handle.texture)].desc;
    }

    const FrameGraph& graph_;
    const CompiledGraph& compiled_;
    const FusionOptions& options_;
    std::map<int, PassUses> uses_;
    std::map<Key, std::vector<int>> users_;
    std::map<Key, int> makers_;
    std::vector<std::vector<int>> groups_;
    std::map<int, int> group_of_;  // by pass
};

}  // namespace

std::vector<Fusion> find_fusions(const FrameGraph& graph, const CompiledGraph& compiled,
                                 const FusionOptions& options) {
    return Finder(graph, compiled, options).find();
}

}  // namespace aftershade::graph
