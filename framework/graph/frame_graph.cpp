#include "framework/graph/frame_graph.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "framework/graph/frame_graph_internal.h"

namespace aftershade::graph {

TextureHandle FrameGraph::add_texture(Texture texture) {
    const gpu::TextureDesc& desc = texture.desc;
    if (desc.width < 1 || desc.height < 1 || desc.layers < 1 || desc.mips < 1)
        throw GraphError(fmt::format("texture '{}' has {}x{} texels, {} layers and {} levels", texture.name,
                                     desc.width, desc.height, desc.layers, desc.mips));
    if (texture.options.auto_mips && gpu::is_integer(desc.format))
        throw GraphError(
            fmt::format("texture '{}' holds integers, of which no mip levels can be made", texture.name));
    texture.filled.assign(std::size_t(desc.mips) * std::size_t(desc.layers),
                          texture.version > 0 || texture.options.clear);
    textures_.push_back(std::move(texture));
    return {int(textures_.size()) - 1, textures_.back().version};
}

BufferHandle FrameGraph::add_buffer(Buffer buffer) {
    if (buffer.desc.bytes == 0) throw GraphError(fmt::format("buffer '{}' has 0 bytes", buffer.name));
    if (buffer.clear && buffer.clear->size() * sizeof(std::uint32_t) > buffer.desc.bytes)
        throw GraphError(fmt::format("buffer '{}' of {} bytes is cleared to {} words", buffer.name,
                                     buffer.desc.bytes, buffer.clear->size()));
    buffers_.push_back(std::move(buffer));
    return {int(buffers_.size()) - 1, buffers_.back().version};
}

TextureHandle FrameGraph::import_texture(std::string name, const gpu::TextureDesc& desc,
                                         bool is_given_each_frame) {
    return add_texture({.name = std::move(name),
                        .desc = desc,
                        .imported = true,
                        .is_given_each_frame = is_given_each_frame,
                        .version = 1});
}

BufferHandle FrameGraph::import_buffer(std::string name, const BufferDesc& desc) {
    return add_buffer({.name = std::move(name), .desc = desc, .imported = true, .version = 1});
}

TextureHandle FrameGraph::create_texture(std::string name, const gpu::TextureDesc& desc,
                                         const TextureOptions& options) {
    return add_texture({.name = std::move(name), .desc = desc, .options = options});
}

BufferHandle FrameGraph::create_buffer(std::string name, const BufferDesc& desc,
                                       std::optional<std::vector<std::uint32_t>> clear) {
    return add_buffer({.name = std::move(name), .desc = desc, .clear = std::move(clear)});
}

TextureHistory FrameGraph::create_history(const std::string& name, const gpu::TextureDesc& desc,
                                          const TextureOptions& options) {
    const TextureHandle current = create_texture(name, desc, options);
    const TextureHandle previous =
        add_texture({.name = name + ".prev", .desc = desc, .previous_of = current.texture, .version = 1});
    return {previous, current};
}

BufferHistory FrameGraph::create_history_buffer(const std::string& name, const BufferDesc& desc,
                                                std::optional<std::vector<std::uint32_t>> clear) {
    const BufferHandle current = create_buffer(name, desc, std::move(clear));
    const BufferHandle previous =
        add_buffer({.name = name + ".prev", .desc = desc, .previous_of = current.buffer, .version = 1});
    return {previous, current};
}

bool FrameGraph::overwrites(const Pass& pass, const Target& target) const {
    const Texture& texture = textures_[std::size_t(target.texture.texture)];
    const bool all_levels = texture.desc.mips == 1 || texture.options.auto_mips || !target.level;
    const bool all_layers = texture.desc.layers == 1 || !target.layer;
    const bool all_texels =
        pass.kind == PassKind::clear || pass.kind == PassKind::copy ||
        ((pass.kind == PassKind::draw || (pass.kind == PassKind::instances && pass.instances.covers)) &&
         pass.blend == gpu::Blend::none);
    return all_levels && all_layers && all_texels;
}

void FrameGraph::fill(const Pass& pass) {
    const auto mark = [&](TextureHandle handle, std::optional<int> level, std::optional<int> layer) {
        Texture& texture = textures_[std::size_t(handle.texture)];
        const bool all_levels = !level || texture.options.auto_mips;
        const int layers = texture.desc.layers;
        for (int i = 0; i < int(texture.filled.size()); ++i)
            if ((all_levels || *level == i / layers) && (!layer || *layer == i % layers))
                texture.filled[std::size_t(i)] = true;
    };
    for (const Target& target : pass.targets) mark(target.texture, target.level, target.layer);
    for (const ImageUse& image : pass.images)
        if (image.access != gpu::Access::read) mark(image.texture, image.level, std::nullopt);
}

Written FrameGraph::add_pass(Pass pass) {
    check_pass(*this, pass);
    fill(pass);
    // A texture that is written twice by one pass is one version further, not two.
    const auto write_texture = [&](TextureHandle handle) {
        textures_[std::size_t(handle.texture)].version = handle.version + 1;
        return TextureHandle{handle.texture, handle.version + 1};
    };
    Written written;
    for (const Target& target : pass.targets) written.targets.push_back(write_texture(target.texture));
    for (const ImageUse& image : pass.images)
        written.images.push_back(image.access == gpu::Access::read ? image.texture
                                                                   : write_texture(image.texture));
    // An image that is only read may be another level of a texture that the pass writes.
    for (TextureHandle& handle : written.images)
        handle.version = textures_[std::size_t(handle.texture)].version;
    for (const BufferUse& use : pass.buffers) {
        int& version = buffers_[std::size_t(use.buffer.buffer)].version;
        if (use.access != gpu::Access::read) ++version;
        written.buffers.push_back({use.buffer.buffer, version});
    }
    passes_.push_back({std::move(pass), written});
    return written;
}

void FrameGraph::fuse(const std::vector<int>& passes, Pass fused, std::vector<TextureHandle> targets) {
    for (const int index : passes) passes_[std::size_t(index)].is_fused_away = true;
    passes_[std::size_t(passes.back())] = {std::move(fused), {.targets = std::move(targets)}};
}

void FrameGraph::keep(TextureHandle handle) {
    const Texture& texture = live(*this, handle, "keep()");
    for (int layer = 0; layer < texture.desc.layers; ++layer)
        if (!texture.is_filled(0, layer))
            throw GraphError(fmt::format("keep() of '{}', of which nothing writes level 0, layer {}",
                                         texture.name, layer));
    textures_[std::size_t(handle.texture)].kept = true;
}

void FrameGraph::keep(BufferHandle handle) {
    const Buffer& buffer = live(*this, handle, "keep()");
    if (!buffer.is_filled())
        throw GraphError(fmt::format("keep() of '{}', which nothing writes", buffer.name));
    buffers_[std::size_t(handle.buffer)].kept = true;
}

}  // namespace aftershade::graph
