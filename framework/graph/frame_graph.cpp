#include "framework/graph/frame_graph.h"

#include <algorithm>
#include <utility>

namespace aftershade::graph {

namespace {

/// First and last pass, by position in the compiled order, that touch a texture.
struct Lifetime {
    int first = -1;
    int last = -1;
    void touch(int position) {
        if (first < 0) first = position;
        last = position;
    }
};

}  // namespace

TextureHandle FrameGraph::import_texture(std::string name, const gpu::TextureDesc& desc) {
    textures_.push_back({std::move(name), desc, true, false, 1});
    return {int(textures_.size()) - 1, 1};
}

TextureHandle FrameGraph::create_texture(std::string name, const gpu::TextureDesc& desc) {
    textures_.push_back({std::move(name), desc, false, false, 0});
    return {int(textures_.size()) - 1, 0};
}

const FrameGraph::Texture& FrameGraph::live(TextureHandle handle, const std::string& user) const {
    if (handle.texture < 0 || handle.texture >= int(textures_.size()))
        throw GraphError(user + " uses a texture that the graph does not have");
    const Texture& texture = textures_[std::size_t(handle.texture)];
    if (handle.version != texture.version)
        throw GraphError(user + " uses version " + std::to_string(handle.version) + " of '" + texture.name +
                         "', which has been written since and is now version " +
                         std::to_string(texture.version));
    return texture;
}

std::vector<TextureHandle> FrameGraph::add_pass(Pass pass, std::span<const TextureHandle> targets) {
    if (targets.empty()) throw GraphError("pass '" + pass.name + "' writes nothing");
    for (const Read& read : pass.reads) {
        const Texture& texture = live(read.texture, "pass '" + pass.name + "'");
        if (texture.version == 0)
            throw GraphError("pass '" + pass.name + "' reads '" + texture.name + "' before any write");
        if (std::find(targets.begin(), targets.end(), read.texture) != targets.end())
            throw GraphError("pass '" + pass.name + "' reads and writes '" + texture.name + "'");
    }
    const gpu::TextureDesc& size = live(targets[0], "pass '" + pass.name + "'").desc;
    std::vector<TextureHandle> written;
    for (const TextureHandle target : targets) {
        const Texture& texture = live(target, "pass '" + pass.name + "'");
        if (texture.imported || texture.kept)
            throw GraphError("pass '" + pass.name + "' writes '" + texture.name +
                             "', which is imported or kept");
        if (texture.desc.width != size.width || texture.desc.height != size.height)
            throw GraphError("pass '" + pass.name + "' writes targets of two sizes");
        written.push_back({target.texture, ++textures_[std::size_t(target.texture)].version});
    }
    passes_.push_back({std::move(pass), written});
    return written;
}

void FrameGraph::keep(TextureHandle handle) {
    if (live(handle, "keep()").version == 0) throw GraphError("keep() of a texture that nothing writes");
    textures_[std::size_t(handle.texture)].kept = true;
}

CompiledGraph FrameGraph::compile() const {
    std::vector<bool> needed(textures_.size());
    for (std::size_t i = 0; i < textures_.size(); ++i) needed[i] = textures_[i].kept;
    CompiledGraph compiled;
    // A pass matters if a later one, or a reader after the frame, needs one of its targets.
    for (int i = pass_count() - 1; i >= 0; --i) {
        const auto& written = targets(i);
        const auto is_needed = [&](TextureHandle t) { return needed[std::size_t(t.texture)]; };
        if (std::none_of(written.begin(), written.end(), is_needed)) continue;
        compiled.passes.push_back(i);
        for (const TextureHandle target : written) needed[std::size_t(target.texture)] = true;
        for (const Read& read : pass(i).reads) needed[std::size_t(read.texture.texture)] = true;
    }
    std::reverse(compiled.passes.begin(), compiled.passes.end());

    const int end = int(compiled.passes.size());
    std::vector<Lifetime> lifetimes(textures_.size());
    for (int position = 0; position < end; ++position) {
        for (const Read& read : pass(compiled.passes[std::size_t(position)]).reads)
            lifetimes[std::size_t(read.texture.texture)].touch(position);
        for (const TextureHandle target : targets(compiled.passes[std::size_t(position)]))
            lifetimes[std::size_t(target.texture)].touch(position);
    }
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        if (textures_[i].imported && needed[i]) lifetimes[i] = {0, end};
        if (textures_[i].kept) lifetimes[i].last = end;
    }

    compiled.slot_of_texture.assign(textures_.size(), -1);
    std::vector<int> order(textures_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = int(i);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return lifetimes[std::size_t(a)].first < lifetimes[std::size_t(b)].first;
    });
    std::vector<int> free_after;  // per slot: the last pass that uses it so far
    for (const int index : order) {
        const Lifetime life = lifetimes[std::size_t(index)];
        if (life.first < 0) continue;
        const gpu::TextureDesc& desc = textures_[std::size_t(index)].desc;
        std::size_t slot = 0;
        while (slot < compiled.slots.size() &&
               !(compiled.slots[slot] == desc && free_after[slot] < life.first))
            ++slot;
        if (slot == compiled.slots.size()) {
            compiled.slots.push_back(desc);
            free_after.push_back(0);
            compiled.bytes += gpu::byte_size(desc);
        }
        free_after[slot] = life.last;
        compiled.slot_of_texture[std::size_t(index)] = int(slot);
        compiled.bytes_unaliased += gpu::byte_size(desc);
    }
    return compiled;
}

}  // namespace aftershade::graph
