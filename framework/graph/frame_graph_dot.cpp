// The graph as Graphviz reads it.
#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "framework/graph/frame_graph.h"
#include "framework/graph/frame_graph_internal.h"

namespace aftershade::graph {
namespace {

std::string label_of(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result;
}

class Dot {
public:
    Dot(const FrameGraph& graph, const CompiledGraph& compiled) : graph_(graph), compiled_(compiled) {}

    std::string run() {
        text_ = "digraph frame {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n";
        for (int i = 0; i < graph_.pass_count(); ++i) {
            if (graph_.is_fused_away(i)) continue;
            runs_ = std::find(compiled_.passes.begin(), compiled_.passes.end(), i) != compiled_.passes.end();
            const char* const grey = runs_ ? "" : ", color=grey, fontcolor=grey";
            text_ += fmt::format("  p{} [shape=box, label=\"{}{}\"{}];\n", i, label_of(graph_.pass(i).name),
                                 graph_.pass(i).computes() ? "\\ncompute" : "", grey);
            const PassUses uses = uses_of(graph_, i);
            for (const Version& version : uses.needs)
                if (exists(version)) edge(node(version), fmt::format("p{}", i));
            for (const Version& version : uses.makes) edge(fmt::format("p{}", i), node(version));
        }
        for (int i = 0; i < int(graph_.textures().size()); ++i)
            history_edge(i, graph_.textures()[std::size_t(i)].previous_of, 0);
        for (int i = 0; i < int(graph_.buffers().size()); ++i)
            history_edge(i, graph_.buffers()[std::size_t(i)].previous_of, int(graph_.textures().size()));
        return text_ + "}\n";
    }

private:
    /// What a first write that keeps its surroundings needs of a resource without content is nothing.
    bool exists(const Version& version) const {
        if (version.version > 0) return true;
        const auto textures = graph_.textures().size();
        const auto index = std::size_t(version.resource);
        return index < textures ? graph_.textures()[index].options.clear.has_value()
                                : graph_.buffers()[index - textures].clear.has_value();
    }

    void edge(const std::string& from, const std::string& to) {
        const std::string line = fmt::format("  {} -> {}{};\n", from, to, runs_ ? "" : " [color=grey]");
        if (edges_.insert(line).second) text_ += line;
    }

    void history_edge(int previous, int current, int offset) {
        if (current < 0) return;
        const int version = offset == 0 ? graph_.textures()[std::size_t(current)].version
                                        : graph_.buffers()[std::size_t(current)].version;
        if (version == 0) return;
        text_ += fmt::format("  {} -> {} [style=dashed, constraint=false];\n",
                             node({offset + current, version}), node({offset + previous, 1}));
    }

    /// The name of the node, which is described at its first mention.
    std::string node(const Version& version) {
        const std::string name = fmt::format("r{}_{}", version.resource, version.version);
        if (nodes_.insert(name).second) describe(name, version);
        return name;
    }

    void describe(const std::string& name, const Version& version) {
        const auto textures = graph_.textures().size();
        const auto index = std::size_t(version.resource);
        std::string label;
        int slot = -1;
        bool is_history = false;
        if (index < textures) {
            const FrameGraph::Texture& texture = graph_.textures()[index];
            const gpu::TextureDesc& desc = texture.desc;
            label = fmt::format("{}\\n{}x{} {}", label_of(texture.name), desc.width, desc.height,
                                gpu::texture_format_name(desc.format));
            if (desc.layers > 1) label += fmt::format(", {} layers", desc.layers);
            if (desc.mips > 1) label += fmt::format(", {} levels", desc.mips);
            slot = compiled_.slot_of_texture[index];
            is_history = is_of_history(graph_.textures(), index);
        } else {
            const FrameGraph::Buffer& buffer = graph_.buffers()[index - textures];
            label = fmt::format("{}\\n{} bytes", label_of(buffer.name), buffer.desc.bytes);
            slot = compiled_.slot_of_buffer[index - textures];
            is_history = is_of_history(graph_.buffers(), index - textures);
        }
        if (version.version > 1) label += fmt::format("\\nversion {}", version.version);
        if (slot >= 0) label += fmt::format("\\n{} {}", index < textures ? "slot" : "buffer slot", slot);
        text_ += fmt::format(
            "  {} [shape={}, label=\"{}\"{}{}];\n", name, index < textures ? "ellipse" : "cylinder", label,
            is_history ? ", style=dashed" : "", slot < 0 ? ", color=grey, fontcolor=grey" : "");
    }

    template <typename Node>
    static bool is_of_history(const std::vector<Node>& nodes, std::size_t index) {
        return nodes[index].previous_of >= 0 || std::any_of(nodes.begin(), nodes.end(), [&](const Node& n) {
                   return n.previous_of == int(index);
               });
    }

    const FrameGraph& graph_;
    const CompiledGraph& compiled_;
    std::string text_;
    std::set<std::string> nodes_;
    std::set<std::string> edges_;
    bool runs_ = true;  // whether the pass at hand does
};

}  // namespace

std::string to_dot(const FrameGraph& graph, const CompiledGraph& compiled) {
    return Dot(graph, compiled).run();
}

}  // namespace aftershade::graph
