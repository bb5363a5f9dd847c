// Passes and the textures between them, as data. Building and compiling need no GL.
#pragma once

#include <cstddef>
#include <cstdint>
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
};

struct UniformBlock {
    int binding = 0;
    std::vector<std::byte> bytes;  ///< std140; contents may be replaced before each frame, the size may not
};

struct Pass {
    std::string name;  ///< "bokeh.coc"
    const gpu::Program* program = nullptr;
    std::vector<Read> reads;
    std::vector<UniformBlock> uniforms;
};

/// A graph made ready to run: which passes, in which order, and which texture lies in which memory.
struct CompiledGraph {
    std::vector<int> passes;           ///< indices of the passes that something kept depends on, in order
    std::vector<int> slot_of_texture;  ///< per texture: index into slots, -1 for one that is not needed
    std::vector<gpu::TextureDesc>
        slots;  ///< memory; textures of one description whose lifetimes do not meet share a slot
    std::uint64_t bytes = 0;            ///< of all slots
    std::uint64_t bytes_unaliased = 0;  ///< what one texture per handle would take
};

class FrameGraph {
public:
    /// A texture whose content is given from outside before every frame.
    TextureHandle import_texture(std::string name, const gpu::TextureDesc& desc);
    /// A transient: lives from its first write to its last read. Reading it before any write is a GraphError.
    TextureHandle create_texture(std::string name, const gpu::TextureDesc& desc);

    /// Appends a draw over `targets`, which all have one size, and returns their new versions. Passes run in
    /// the order of the calls.
    [[nodiscard]] std::vector<TextureHandle> add_pass(Pass pass, std::span<const TextureHandle> targets);

    /// Marks a texture that is read after the frame: an output or a tap. Nothing may write it afterwards.
    void keep(TextureHandle handle);

    CompiledGraph compile() const;

    struct Texture {
        std::string name;
        gpu::TextureDesc desc;
        bool imported = false;
        bool kept = false;
        int version = 0;
    };
    const std::vector<Texture>& textures() const { return textures_; }
    const Pass& pass(int index) const { return passes_[std::size_t(index)].pass; }
    Pass& pass(int index) { return passes_[std::size_t(index)].pass; }
    const std::vector<TextureHandle>& targets(int index) const { return passes_[std::size_t(index)].targets; }
    int pass_count() const { return int(passes_.size()); }

private:
    struct Node {
        Pass pass;
        std::vector<TextureHandle> targets;  // the versions that it writes
    };
    const Texture& live(TextureHandle handle, const std::string& user) const;

    std::vector<Texture> textures_;
    std::vector<Node> passes_;
};

}  // namespace aftershade::graph
