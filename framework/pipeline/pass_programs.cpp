#include "framework/pipeline/pass_programs.h"

#include <algorithm>
#include <utility>

namespace aftershade {

namespace {

/// The passes of a fusion as one pass of the graph and one program; bindings rise from part to part.
class FusedPassMaker {
public:
    FusedPassMaker(const graph::FrameGraph& graph, const graph::Fusion& fusion)
        : graph_(graph), fusion_(fusion) {}

    void add(int index, const ShaderContext& shader, std::vector<int> unused_blocks) {
        const graph::Pass& pass = graph_.pass(index);
        FusedShader part{shader, {}, {}};
        part.part.first_sampler = int(fused_.reads.size());
        part.part.first_block = kBlocksPerPart * int(program_.parts.size());
        part.part.first_buffer = int(fused_.buffers.size());
        part.part.left_out = std::move(unused_blocks);
        add_reads(pass, part);
        for (graph::BufferUse use : pass.buffers) {
            use.binding = int(fused_.buffers.size());
            fused_.buffers.push_back(use);
        }
        for (graph::UniformBlock block : pass.uniforms) {
            if (part.part.leaves_out(block.binding)) continue;
            block.binding += part.part.first_block;
            fused_.uniforms.push_back(std::move(block));
        }
        fused_.name += (fused_.name.empty() ? "" : "+") + pass.name;
        program_.parts.push_back(std::move(part));
    }

    /// After all parts.
    void add_targets() {
        for (const graph::TextureHandle& target : fusion_.targets) {
            const HeldRead made = maker_of(target);
            program_.targets.push_back({made.part, made.write});
            fused_.targets.push_back({target});
        }
    }

    const FusedProgram& program() const { return program_; }
    graph::Pass pass(std::shared_ptr<const gpu::Program> program) {
        fused_.program = std::move(program);
        return std::move(fused_);
    }

private:
    void add_reads(const graph::Pass& pass, FusedShader& part) {
        const std::vector<ReadSpec> reads = pass_bindings(part.shader).reads;
        for (std::size_t i = 0; i < pass.reads.size(); ++i) {
            HeldRead held = maker_of(pass.reads[i].texture);
            if (held.part < 0) {
                graph::Read read = pass.reads[i];
                read.binding = int(fused_.reads.size());
                fused_.reads.push_back(read);
                continue;
            }
            held.read = reads[i].glsl_name();
            part.part.held.push_back(held.read);
            part.held.push_back(std::move(held));
        }
    }

    /// Which of the parts so far makes the texture; part -1: none.
    HeldRead maker_of(graph::TextureHandle texture) const {
        for (std::size_t i = 0; i < program_.parts.size(); ++i) {
            const auto& made = graph_.written(fusion_.passes[i]).targets;
            const auto found = std::ranges::find(made, texture);
            if (found == made.end()) continue;
            const auto write = std::size_t(found - made.begin());
            return {"", int(i), pass_bindings(program_.parts[i].shader).writes[write].name};
        }
        return {"", -1, ""};
    }

    const graph::FrameGraph& graph_;
    const graph::Fusion& fusion_;
    FusedProgram program_;
    graph::Pass fused_;
};

void point_to_fused(std::vector<BlockBinding>& blocks, const std::vector<int>& passes,
                    const std::vector<FusedShader>& parts) {
    for (BlockBinding& block : blocks) {
        std::erase_if(block.places, [&](BlockPlace& place) {
            const auto found = std::ranges::find(passes, place.pass);
            if (found == passes.end()) return false;
            const FusedPart& part = parts[std::size_t(found - passes.begin())].part;
            const bool is_left_out = part.leaves_out(place.binding);
            place = {passes.back(), place.binding + part.first_block};
            return is_left_out;
        });
        std::ranges::stable_sort(block.places, {}, &BlockPlace::pass);
    }
}

}  // namespace

WorkStatus status_of_pass(const PipelineStep& step, const std::string& pass, const std::string& phase,
                          const StatusWriter* status) {
    return {step.name,         "",   phase,          status ? status->current().frame : std::nullopt,
            step.manifest->id, pass, step.is_foreign};
}

void PassPrograms::add(int pass, const ShaderContext& shader, const PipelineStep& step) {
    added_.emplace(pass, Added{shader, &step});
}

WorkStatus PassPrograms::compiling(const Added& added, const std::string& pass) const {
    return status_of_pass(*added.step, pass, "compile", tools_.status);
}

const std::vector<int>& PassPrograms::unused_blocks_of(int pass) {
    const auto known = unused_.find(pass);
    if (known != unused_.end()) return known->second;
    return unused_[pass] = unused_blocks(added_.at(pass).shader);
}

int PassPrograms::blocks_of(const graph::FrameGraph& graph, int pass) {
    const auto [count, is_new] = block_counts_.try_emplace(pass, 0);
    return is_new ? count->second = count_blocks(graph, pass) : count->second;
}

int PassPrograms::count_blocks(const graph::FrameGraph& graph, int pass) {
    if (!fault_of_fusing(added_.at(pass).shader).empty()) return kMaxFusedBlocks + 1;
    const std::vector<int>& unused = unused_blocks_of(pass);
    return int(std::ranges::count_if(graph.pass(pass).uniforms, [&](const graph::UniformBlock& block) {
        return std::ranges::find(unused, block.binding) == unused.end();
    }));
}

void PassPrograms::finish(graph::FrameGraph& graph, std::vector<BlockBinding>& blocks, int divide_at) {
    if (tools_.fuses && !tools_.programs.is_guarding_loops()) {
        const graph::FusionOptions options{
            {kMaxFusedParts, kMaxFusedSamplers, kMaxFusedBuffers, kMaxFusedBlocks}, divide_at, [&](int pass) {
                return blocks_of(graph, pass);
            }};
        for (const graph::Fusion& fusion : graph::find_fusions(graph, graph.compile(), options))
            fuse(graph, fusion, blocks);
    }
    for (const auto& [pass, added] : added_) {
        if (graph.is_fused_away(pass) || graph.pass(pass).program) continue;
        const StatusScope scope(tools_.status, compiling(added, added.shader.pass->name));
        graph.pass(pass).program = tools_.programs.get(added.shader);
    }
}

void PassPrograms::fuse(graph::FrameGraph& graph, const graph::Fusion& fusion,
                        std::vector<BlockBinding>& blocks) {
    FusedPassMaker maker(graph, fusion);
    std::string names;
    for (const int pass : fusion.passes) {
        maker.add(pass, added_.at(pass).shader, unused_blocks_of(pass));
        names += (names.empty() ? "" : "+") + added_.at(pass).shader.pass->name;
    }
    maker.add_targets();
    const StatusScope scope(tools_.status, compiling(added_.at(fusion.passes.front()), names));
    std::shared_ptr<const gpu::Program> program = tools_.programs.fused(maker.program());
    if (!program) return;
    point_to_fused(blocks, fusion.passes, maker.program().parts);
    graph.fuse(fusion.passes, maker.pass(std::move(program)), fusion.targets);
}

}  // namespace aftershade
