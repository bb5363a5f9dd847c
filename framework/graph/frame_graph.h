// Passes and the textures and buffers between them, as data. Building and compiling need no GL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/gpu/commands.h"

namespace aftershade::graph {

/// A texture as it is after a certain write. Writing makes a new version, and the old handle dies.
struct TextureHandle {
    int texture = -1;
    int version = 0;
    bool operator==(const TextureHandle&) const = default;
};

/// The same for a buffer.
struct BufferHandle {
    int buffer = -1;
    int version = 0;
    bool operator==(const BufferHandle&) const = default;
};

/// A graph that cannot be run: a bug of the code that built it.
class GraphError : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

struct Read {
    TextureHandle texture;
    int binding = 0;  ///< of the sampler
    gpu::Filter filter = gpu::Filter::nearest;
    gpu::Wrap wrap = gpu::Wrap::clamp;
    std::optional<int> level{};  ///< the only level that is seen, as level 0; nullopt: all
    bool is_pixel = false;       ///< each pixel of the pass needs the texel at its own place alone
};

/// One level and layer that a draw renders to or a clear sets. In a clear and a copy nullopt is every one.
struct Target {
    TextureHandle texture;
    std::optional<int> level = 0;
    std::optional<int> layer = 0;
};

struct ImageUse {
    TextureHandle texture;
    int binding = 0;
    gpu::Access access = gpu::Access::read;
    int level = 0;
};

struct BufferUse {
    BufferHandle buffer;
    int binding = 0;  ///< of the storage block
    gpu::Access access = gpu::Access::read;
};

struct UniformBlock {
    int binding = 0;
    std::vector<std::byte> bytes;  ///< std140; contents may be replaced before each frame, the size may not
};

/// `copy`: level 0 of its read to its target, bit for bit; both have one description.
enum class PassKind { draw, instances, compute, clear, copy };
constexpr bool runs_program(PassKind kind) {
    return kind != PassKind::clear && kind != PassKind::copy;
}

/// The size of `instances`: `count` times four vertices of a strip (quads) or one point; or as many as the
/// buffer says (DrawArraysIndirectCommand).
struct Instances {
    gpu::Primitive primitive = gpu::Primitive::quads;
    int count = 0;
    std::optional<BufferHandle> indirect{};
    bool covers = false;  ///< the targets as a whole, which nothing need have filled
};

/// Work groups of a compute pass; or as many as the buffer says (DispatchIndirectCommand).
struct Groups {
    std::array<int, 3> count = {1, 1, 1};
    std::optional<BufferHandle> indirect{};
};

/// Whether a pass may be one part of a fused pass (framework/graph/fusion.h): not at all, the first, or one
/// that begins with what others make.
enum class Fusing { never, leads, follows };

struct Pass {
    std::string name;  ///< "bokeh.coc"
    PassKind kind = PassKind::draw;
    std::shared_ptr<const gpu::Program> program{};  ///< nullptr where the kind runs none
    std::vector<Read> reads{};
    std::vector<Target> targets{};  ///< draw, instances: of one size; clear: what is set to `clear_value`
    std::vector<ImageUse> images{};
    std::vector<BufferUse> buffers{};
    std::vector<UniformBlock> uniforms{};
    gpu::Blend blend = gpu::Blend::none;
    Instances instances{};
    Groups groups{};
    std::array<double, 4> clear_value = {0, 0, 0, 0};
    Fusing fusing = Fusing::never;
    /// Unit of the first target, for a draw or for instances that are tiles, if their program is a compute
    /// shader that stores the targets as images. nullopt: fragments draw them.
    std::optional<int> first_target_unit{};
    /// Why a compute shader cannot do that; "" where it does, or where none was requested.
    std::string why_drawn{};

    bool computes() const { return kind == PassKind::compute || first_target_unit; }
};

/// The results of a pass: new versions of the resources that it wrote. A texture that a pass writes in
/// several places (two layers, say) becomes one new version.
struct Written {
    std::vector<TextureHandle> targets{};  ///< one for each of Pass::targets
    std::vector<TextureHandle> images{};   ///< one for each of Pass::images; as it was where that only reads
    std::vector<BufferHandle> buffers{};   ///< one for each of Pass::buffers; as it was where that only reads
};

struct TextureOptions {
    bool auto_mips = false;  ///< levels 1.. are filled from level 0 after each pass that writes the texture
    std::optional<std::array<double, 4>> clear{};  ///< content before the first write of each frame
    bool partial = false;                          ///< no pass reads a texel that none has drawn
};

struct BufferDesc {
    std::size_t bytes = 0;
    bool operator==(const BufferDesc&) const = default;
};

/// A resource that survives into the next frame: `current` is written, and becomes `previous` when the frame
/// ends. Where no pass writes `current` in a frame, `previous` stays as it was.
struct TextureHistory {
    TextureHandle previous;  ///< readable from the beginning; zero where there was no frame before
    TextureHandle current;
};
struct BufferHistory {
    BufferHandle previous;
    BufferHandle current;
};

/// A graph made ready to run: which passes, in which order, and which texture lies in which memory.
struct CompiledGraph {
    std::vector<int> passes;  ///< indices of the passes that something kept depends on, in order
    /// Per texture: index into slots, -1 for one that is not needed. A copy whose source nothing needs
    /// afterwards has both its textures in one slot, and there is nothing to copy.
    std::vector<int> slot_of_texture;
    std::vector<gpu::TextureDesc> slots;  ///< memory; textures whose lifetimes do not meet and that
                                          ///< gpu::may_share_memory() share a slot
    std::vector<int> slot_of_buffer;
    std::vector<int> first_in_slot;  ///< of the textures in each slot, the one that a frame uses first
    std::vector<BufferDesc> buffer_slots;
    /// Per texture and per buffer: position in `passes` of the pass before which it is set to its `clear`,
    /// passes.size() for the end of the frame; -1 where nothing would see it.
    std::vector<int> texture_cleared_before;
    std::vector<int> buffer_cleared_before;
    std::uint64_t bytes = 0;            ///< of all slots
    std::uint64_t bytes_unaliased = 0;  ///< what one texture per handle would take
};

class FrameGraph {
public:
    /// A texture whose content is given from outside. `is_given_each_frame`: before every run, so that its
    /// memory may hold something else once no pass needs it.
    TextureHandle import_texture(std::string name, const gpu::TextureDesc& desc,
                                 bool is_given_each_frame = false);
    /// A buffer whose content is given from outside, such as a table of parameters.
    BufferHandle import_buffer(std::string name, const BufferDesc& desc);
    /// A transient: lives from its first write to its last read. Reading one that is not cleared before any
    /// write is a GraphError.
    TextureHandle create_texture(std::string name, const gpu::TextureDesc& desc,
                                 const TextureOptions& options = {});
    /// `clear`: the first words at the beginning of each frame, the rest 0; nullopt: not cleared.
    BufferHandle create_buffer(std::string name, const BufferDesc& desc,
                               std::optional<std::vector<std::uint32_t>> clear = {});
    /// The texture to write takes `name`, what it was in the frame before is called `<name>.prev`.
    TextureHistory create_history(const std::string& name, const gpu::TextureDesc& desc,
                                  const TextureOptions& options = {});
    BufferHistory create_history_buffer(const std::string& name, const BufferDesc& desc,
                                        std::optional<std::vector<std::uint32_t>> clear = {});

    /// Appends a pass and returns the new versions of what it writes. Passes run in the order of the calls.
    /// A draw without blending that covers the only level and layer of its target needs nothing of what was
    /// there; every other write (blending, instances, images, buffers, one level of many) keeps it.
    /// A pass may read a texture that it writes only where the levels differ: one level sampled, another
    /// drawn to or stored to. Throws GraphError, and then the graph is as it was.
    [[nodiscard]] Written add_pass(Pass pass);
    /// Whether `target` of `pass` leaves nothing of what its texture held.
    bool overwrites(const Pass& pass, const Target& target) const;

    /// Replaces draws, by rising indices, by one that makes `targets` of what they made, at the place of the
    /// last; the others stay without use. See framework/graph/fusion.h for which may be.
    void fuse(const std::vector<int>& passes, Pass fused, std::vector<TextureHandle> targets);
    /// Whether the pass was replaced by one that follows.
    bool is_fused_away(int index) const { return passes_[std::size_t(index)].is_fused_away; }

    /// Marks a texture that is read after the frame: an output or a tap. Nothing may write it afterwards.
    void keep(TextureHandle handle);
    void keep(BufferHandle handle);

    /// Culls passes that nothing kept depends on. A history is written only where a pass that is not culled
    /// reads what it was in the frame before. Without `shares_memory` every texture and buffer that is needed
    /// has memory of its own, which holds what it held until a pass writes it again.
    CompiledGraph compile(bool shares_memory = true) const;

    struct Texture {
        std::string name;
        gpu::TextureDesc desc;
        TextureOptions options{};
        bool imported = false;
        bool is_given_each_frame = false;
        bool kept = false;
        int previous_of = -1;  ///< of a history's `previous`: the texture that is its `current`
        int version = 0;
        std::vector<bool> filled{};  ///< by level * layers + layer: holds something at this version

        bool is_filled(int level, int layer) const {
            return filled[std::size_t(level * desc.layers + layer)];
        }
    };
    struct Buffer {
        std::string name;
        BufferDesc desc;
        std::optional<std::vector<std::uint32_t>> clear{};
        bool imported = false;
        bool kept = false;
        int previous_of = -1;
        int version = 0;

        bool is_filled() const { return version > 0 || clear; }
    };
    const std::vector<Texture>& textures() const { return textures_; }
    const std::vector<Buffer>& buffers() const { return buffers_; }
    const Pass& pass(int index) const { return passes_[std::size_t(index)].pass; }
    Pass& pass(int index) { return passes_[std::size_t(index)].pass; }
    const Written& written(int index) const { return passes_[std::size_t(index)].written; }
    int pass_count() const { return int(passes_.size()); }

private:
    struct Node {
        Pass pass;
        Written written;
        bool is_fused_away = false;
    };

    TextureHandle add_texture(Texture texture);
    BufferHandle add_buffer(Buffer buffer);
    void fill(const Pass& pass);

    std::vector<Texture> textures_;
    std::vector<Buffer> buffers_;
    std::vector<Node> passes_;
};

/// The graph in Graphviz's language: passes as boxes, textures as ellipses with size, format and slot; what
/// is culled in grey, history dashed.
std::string to_dot(const FrameGraph& graph, const CompiledGraph& compiled);

}  // namespace aftershade::graph
