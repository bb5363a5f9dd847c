#include "framework/graph/frame_graph_internal.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace aftershade::graph {
namespace {

int side(int full, int level) {
    return std::max(1, full >> level);
}

/// What a pass does with some levels and layers of a texture; nullopt: with every one.
struct Use {
    enum class As { sampler, target, image };
    As as = As::sampler;
    int texture = -1;
    std::optional<int> level;
    std::optional<int> layer;
    bool writes = false;
};

bool meet(std::optional<int> a, std::optional<int> b) {
    return !a || !b || *a == *b;
}

class PassCheck {
public:
    PassCheck(const FrameGraph& graph, const Pass& pass)
        : graph_(graph), pass_(pass), user_(fmt::format("pass '{}'", pass.name)) {}

    void run() {
        check_kind();
        check_counts();
        check_bindings();
        for (const Read& read : pass_.reads) check_read(read);
        for (const Target& target : pass_.targets) check_target(target);
        for (const ImageUse& image : pass_.images) check_image(image);
        for (const BufferUse& buffer : pass_.buffers) check_buffer(buffer);
        check_overlaps();
        check_buffer_overlaps();
    }

private:
    using Texture = FrameGraph::Texture;

    [[noreturn]] void fail(const std::string& why) const { throw GraphError(user_ + " " + why); }

    bool draws() const { return pass_.kind == PassKind::draw || pass_.kind == PassKind::instances; }

    void check_kind() const {
        const bool writes_memory =
            std::any_of(pass_.images.begin(), pass_.images.end(),
                        [](const ImageUse& use) { return use.access != gpu::Access::read; }) ||
            std::any_of(pass_.buffers.begin(), pass_.buffers.end(),
                        [](const BufferUse& use) { return use.access != gpu::Access::read; });
        if (pass_.targets.empty() && !writes_memory) fail("writes nothing");
        if (draws() && pass_.targets.empty()) fail("draws, but has no target");
        if (pass_.kind == PassKind::compute && !pass_.targets.empty())
            fail(fmt::format("computes, but has {} targets; it can write images and buffers",
                             pass_.targets.size()));
        if (pass_.kind == PassKind::clear &&
            (pass_.program || !pass_.reads.empty() || !pass_.images.empty() || !pass_.buffers.empty() ||
             !pass_.uniforms.empty()))
            fail("clears, but has more than targets; it runs no program and reads nothing");
        if (pass_.kind == PassKind::copy) check_copy();
        if (!draws() && pass_.blend != gpu::Blend::none) fail("blends, but draws nothing");
        if (pass_.program && pass_.program->is_compute() != pass_.computes())
            fail(fmt::format("{}, but its program '{}' does the other",
                             pass_.computes() ? "computes" : "draws", pass_.program->label()));
    }

    void check_copy() const {
        if (pass_.program || pass_.reads.size() != 1 || pass_.targets.size() != 1 || !pass_.images.empty() ||
            !pass_.buffers.empty() || !pass_.uniforms.empty())
            fail("copies, but has more or less than one read and one target");
        const Texture& from = live(graph_, pass_.reads.front().texture, user_);
        const Texture& to = live(graph_, pass_.targets.front().texture, user_);
        const gpu::TextureDesc &a = from.desc, &b = to.desc;
        if (a.width != b.width || a.height != b.height || a.format != b.format || a.mips < b.mips ||
            a.layers > 1 || b.layers > 1)
            fail(fmt::format("copies '{}' to '{}', which differ in size, format, levels or layers", from.name,
                             to.name));
        if (const auto level = pass_.targets.front().level; level && (*level > 0 || b.mips > 1))
            fail(fmt::format("copies '{}' to level {} of '{}' alone; copies take every level", from.name,
                             *level, to.name));
    }

    void check_counts() const {
        if (pass_.kind != PassKind::instances && (pass_.instances.count != 0 || pass_.instances.indirect))
            fail("has a number of instances, but does not draw instances");
        if (pass_.kind != PassKind::compute && pass_.groups.indirect)
            fail("has a number of groups, but does not compute");
        if (pass_.instances.count < 0) fail(fmt::format("draws {} instances", pass_.instances.count));
        for (const int count : pass_.groups.count)
            if (count < 1) fail(fmt::format("dispatches {} groups along one axis; at least 1", count));
        for (const auto& indirect : {pass_.instances.indirect, pass_.groups.indirect}) {
            if (!indirect) continue;
            const FrameGraph::Buffer& buffer = live(graph_, *indirect, user_);
            if (!buffer.is_filled())
                fail(fmt::format("takes its count from '{}' before any write", buffer.name));
            const std::size_t least = pass_.kind == PassKind::compute ? 12 : 16;
            if (buffer.desc.bytes < least)
                fail(fmt::format("takes its count from '{}' of {} bytes; the command takes {}", buffer.name,
                                 buffer.desc.bytes, least));
        }
    }

    template <typename Uses>
    void check_distinct(const Uses& uses, std::string_view what) const {
        for (std::size_t i = 0; i < uses.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (uses[i].binding == uses[j].binding)
                    fail(fmt::format("has two {} at binding {}", what, uses[i].binding));
    }

    void check_bindings() const {
        check_distinct(pass_.reads, "samplers");
        check_distinct(pass_.images, "images");
        check_distinct(pass_.buffers, "storage blocks");
        check_distinct(pass_.uniforms, "uniform blocks");
        for (const UniformBlock& block : pass_.uniforms)
            if (block.bytes.empty())
                fail(fmt::format("has an empty uniform block at binding {}", block.binding));
    }

    void check_range(const Texture& texture, std::optional<int> of_level, std::optional<int> of_layer) const {
        const int level = of_level.value_or(0), layer = of_layer.value_or(0);
        if (level >= texture.desc.mips || level < 0)
            fail(fmt::format("uses level {} of '{}', which has {}", level, texture.name, texture.desc.mips));
        if (layer >= texture.desc.layers || layer < 0)
            fail(
                fmt::format("uses layer {} of '{}', which has {}", layer, texture.name, texture.desc.layers));
    }

    /// `level`, `layer`: nullopt for every one. `does` says what it does that needs content.
    void check_filled(const Texture& texture, std::optional<int> level, std::optional<int> layer,
                      std::string_view does) const {
        const bool any =
            std::find(texture.filled.begin(), texture.filled.end(), true) != texture.filled.end();
        if (!any) fail(fmt::format("{} '{}' before any write", does, texture.name));
        for (int i = level.value_or(0); i <= level.value_or(texture.desc.mips - 1); ++i)
            for (int k = layer.value_or(0); k <= layer.value_or(texture.desc.layers - 1); ++k)
                if (!texture.is_filled(i, k))
                    fail(fmt::format("{} '{}' before any write to its level {}, layer {}", does, texture.name,
                                     i, k));
    }

    void check_writable(const Texture& texture) const {
        if (texture.imported) fail(fmt::format("writes '{}', which is imported", texture.name));
        if (texture.previous_of >= 0)
            fail(fmt::format("writes '{}', which is what the frame before left", texture.name));
        if (texture.kept) fail(fmt::format("writes '{}', which is kept as it was", texture.name));
    }

    void check_auto_mips(const Texture& texture, int level) const {
        if (level > 0 && texture.options.auto_mips)
            fail(fmt::format("writes level {} of '{}', whose levels are filled from level 0", level,
                             texture.name));
    }

    void check_read(const Read& read) const {
        const Texture& texture = live(graph_, read.texture, user_);
        check_range(texture, read.level, 0);
        check_filled(texture, read.level, std::nullopt, "reads");
        if (read.filter == gpu::Filter::linear && gpu::is_integer(texture.desc.format))
            fail(fmt::format("reads '{}' with a linear filter, but it holds integers", texture.name));
    }

    void check_target(const Target& target) const {
        const Texture& texture = live(graph_, target.texture, user_);
        check_writable(texture);
        check_range(texture, target.level, target.layer);
        check_auto_mips(texture, target.level.value_or(0));
        if (pass_.kind == PassKind::clear || pass_.kind == PassKind::copy) return;
        if (!target.level || !target.layer)
            fail(fmt::format("draws to every level or layer of '{}' at once", texture.name));
        const Target& first = pass_.targets.front();
        const gpu::TextureDesc& desc = live(graph_, first.texture, user_).desc;
        const int level = *target.level, first_level = first.level.value_or(0);
        const int width = side(texture.desc.width, level), height = side(texture.desc.height, level);
        const int first_width = side(desc.width, first_level), first_height = side(desc.height, first_level);
        if (width != first_width || height != first_height)
            fail(fmt::format("writes targets of two sizes: '{}' is {}x{}, '{}' is {}x{}",
                             graph_.textures()[std::size_t(first.texture.texture)].name, first_width,
                             first_height, texture.name, width, height));
        if (pass_.blend != gpu::Blend::none) {
            if (gpu::is_integer(texture.desc.format))
                fail(fmt::format("blends onto '{}', which holds integers", texture.name));
            check_filled(texture, target.level, target.layer, "blends onto");
        } else if (pass_.kind == PassKind::instances && !pass_.instances.covers && !texture.options.partial) {
            check_filled(texture, target.level, target.layer, "draws over parts of");
        }
    }

    void check_image(const ImageUse& image) const {
        const Texture& texture = live(graph_, image.texture, user_);
        check_range(texture, image.level, 0);
        if (image.access != gpu::Access::read) {
            check_writable(texture);
            check_auto_mips(texture, image.level);
        }
        if (image.access != gpu::Access::write) check_filled(texture, image.level, std::nullopt, "reads");
    }

    void check_buffer(const BufferUse& use) const {
        const FrameGraph::Buffer& buffer = live(graph_, use.buffer, user_);
        if (use.access != gpu::Access::write && !buffer.is_filled())
            fail(fmt::format("reads '{}' before any write", buffer.name));
        if (use.access == gpu::Access::read) return;
        if (buffer.imported) fail(fmt::format("writes '{}', which is imported", buffer.name));
        if (buffer.previous_of >= 0)
            fail(fmt::format("writes '{}', which is what the frame before left", buffer.name));
        if (buffer.kept) fail(fmt::format("writes '{}', which is kept as it was", buffer.name));
    }

    std::vector<Use> texture_uses() const {
        std::vector<Use> uses;
        for (const Read& read : pass_.reads)
            uses.push_back({Use::As::sampler, read.texture.texture, read.level, std::nullopt, false});
        for (const Target& target : pass_.targets)
            uses.push_back({Use::As::target, target.texture.texture, target.level, target.layer, true});
        for (const ImageUse& image : pass_.images)
            uses.push_back({Use::As::image, image.texture.texture, image.level, std::nullopt,
                            image.access != gpu::Access::read});
        return uses;
    }

    void check_overlaps() const {
        const std::vector<Use> uses = texture_uses();
        for (std::size_t i = 0; i < uses.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                if (uses[i].texture != uses[j].texture || !meet(uses[i].level, uses[j].level) ||
                    !meet(uses[i].layer, uses[j].layer))
                    continue;
                check_overlap(uses[j], uses[i]);
            }
    }

    /// Two uses of the same texels; samplers come first in texture_uses(), images last.
    void check_overlap(const Use& a, const Use& b) const {
        const std::string& name = graph_.textures()[std::size_t(a.texture)].name;
        using enum Use::As;
        if (a.as == sampler && b.as == image && !b.writes)
            fail(fmt::format("uses '{}' as an image and through a sampler", name));
        if (a.as == sampler && b.as != sampler) fail(fmt::format("reads and writes '{}'", name));
        if (a.as == target && b.as == target) fail(fmt::format("has '{}' as a target twice", name));
        if (a.as == target) fail(fmt::format("draws to '{}' and uses it as an image", name));
        if (a.as == image && (a.writes || b.writes))
            fail(fmt::format("uses '{}' as two images and writes one of them", name));
    }

    void check_buffer_overlaps() const {
        std::vector<BufferUse> uses = pass_.buffers;
        if (pass_.instances.indirect) uses.push_back({*pass_.instances.indirect});
        if (pass_.groups.indirect) uses.push_back({*pass_.groups.indirect});
        for (std::size_t i = 0; i < uses.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (uses[i].buffer == uses[j].buffer &&
                    (uses[i].access != gpu::Access::read || uses[j].access != gpu::Access::read))
                    fail(fmt::format("uses '{}' twice and writes it",
                                     graph_.buffers()[std::size_t(uses[i].buffer.buffer)].name));
    }

    const FrameGraph& graph_;
    const Pass& pass_;
    std::string user_;
};

template <typename Resource>
const Resource& live_of(const std::vector<Resource>& all, int index, int version, std::string_view what,
                        std::string_view user) {
    if (index < 0 || index >= int(all.size()))
        throw GraphError(fmt::format("{} uses a {} that the graph does not have", user, what));
    const Resource& resource = all[std::size_t(index)];
    if (version != resource.version)
        throw GraphError(
            fmt::format("{} uses version {} of '{}', which has been written since and is now version {}",
                        user, version, resource.name, resource.version));
    return resource;
}

}  // namespace

const FrameGraph::Texture& live(const FrameGraph& graph, TextureHandle handle, std::string_view user) {
    return live_of(graph.textures(), handle.texture, handle.version, "texture", user);
}

const FrameGraph::Buffer& live(const FrameGraph& graph, BufferHandle handle, std::string_view user) {
    return live_of(graph.buffers(), handle.buffer, handle.version, "buffer", user);
}

void check_pass(const FrameGraph& graph, const Pass& pass) {
    PassCheck(graph, pass).run();
}

}  // namespace aftershade::graph
