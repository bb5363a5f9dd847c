#include "framework/render/pass_programs.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace aftershade {

/// The passes of a fusion as one pass of the graph and one program; bindings rise from part to part.
class FusedPassMaker {
public:
    FusedPassMaker(const graph::FrameGraph& graph, graph::Fusion fusion)
        : graph_(&graph), fusion_(std::move(fusion)) {}

    void add(int index, const ShaderContext& shader, std::vector<int> unused_blocks) {
        const graph::Pass& pass = graph_->pass(index);
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
    /// Without its program.
    const graph::Pass& pass() const { return fused_; }
    graph::Pass& pass() { return fused_; }
    const graph::Fusion& fusion() const { return fusion_; }

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
            const auto& made = graph_->written(fusion_.passes[i]).targets;
            const auto found = std::ranges::find(made, texture);
            if (found == made.end()) continue;
            const auto write = std::size_t(found - made.begin());
            return {"", int(i), pass_bindings(program_.parts[i].shader).writes[write].name};
        }
        return {"", -1, ""};
    }

    const graph::FrameGraph* graph_;
    graph::Fusion fusion_;
    FusedProgram program_;
    graph::Pass fused_;
};

namespace {

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
    added_.emplace(pass, Added{shader, &step}).first->second.shader.texts = &texts_;
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

/// A way to run a pass: its program, and what it binds for that.
struct PassPrograms::Form {
    std::shared_ptr<const ProgramSources> sources;
    std::vector<graph::ImageUse> images;
    std::optional<int> first_target_unit{};
};

/// A pass's texts, and what is wrong with them.
struct PassPrograms::Assembled {
    Form own;                     ///< as the manifest has it
    std::optional<Form> compute;  ///< of a draw
    std::string why_drawn;        ///< why there is none, where one is wanted
    Diagnostics faults;

    const Form& form() const { return compute ? *compute : own; }
    void give(graph::Pass& pass) const {
        pass.images = form().images;
        pass.first_target_unit = form().first_target_unit;
        pass.why_drawn = why_drawn;
    }
};

struct PassPrograms::FusedAssembled {
    FusedPassMaker maker;
    std::string names;  ///< of the passes
    Assembled texts;

    const std::vector<int>& passes() const { return maker.fusion().passes; }
};

std::vector<PassPrograms::FusedAssembled> PassPrograms::assemble_fusions(const graph::FrameGraph& graph,
                                                                         const graph::CompiledGraph& compiled,
                                                                         int divide_at) {
    std::vector<FusedAssembled> fusions;
    if (!tools_.fuses || tools_.programs.is_guarding_loops()) return fusions;
    const graph::FusionOptions options{{kMaxFusedParts, kMaxFusedSamplers, kMaxFusedBuffers, kMaxFusedBlocks},
                                       divide_at,
                                       [&](int pass) { return blocks_of(graph, pass); }};
    for (const graph::Fusion& fusion : graph::find_fusions(graph, compiled, options)) {
        FusedAssembled fused{FusedPassMaker(graph, fusion), "", {}};
        for (const int pass : fusion.passes) {
            fused.maker.add(pass, added_.at(pass).shader, unused_blocks_of(pass));
            fused.names += (fused.names.empty() ? "" : "+") + added_.at(pass).shader.pass->name;
        }
        fused.maker.add_targets();
        ProgramSources sources = tools_.programs.sources_of(fused.maker.program(), fused.texts.faults);
        assemble_forms(graph, fused.maker.pass(), std::move(sources), nullptr, fused.texts);
        fusions.push_back(std::move(fused));
    }
    return fusions;
}

/// Where that is the faster way, the pass loads from images what its text fetches.
PassPrograms::Form PassPrograms::with_loads(const graph::FrameGraph& graph, const graph::Pass& pass,
                                            ProgramSources sources, int first_unit) const {
    Form form{nullptr, pass.images};
    if (const int units = tools_.loads_images ? tools_.context.info().load_units : 0; units > 0) {
        std::map<int, gpu::TextureFormat> formats;
        for (const graph::Read& read : pass.reads)
            formats[read.binding] = graph.textures()[std::size_t(read.texture.texture)].desc.format;
        for (const ImageLoad& load : load_as_images(sources.main, formats, first_unit, units)) {
            const auto read = std::ranges::find(pass.reads, load.sampler, &graph::Read::binding);
            form.images.push_back({read->texture, load.unit, gpu::Access::read, read->level.value_or(0)});
        }
    }
    form.sources = std::make_shared<const ProgramSources>(std::move(sources));
    return form;
}

namespace {

/// By the manifest: "blends"; what the shader's text forbids is found by itself.
std::string fault_of_computing(const graph::Pass& pass, const PassSpec* spec) {
    if (pass.blend != gpu::Blend::none) return "blends";
    if (spec && spec->vertex()) return "has a vertex shader";
    if (pass.kind == graph::PassKind::instances && (!spec || !spec->over())) return "draws instances";
    return "";
}

}  // namespace

/// Its targets become the images behind the pass's own.
std::optional<ProgramSources> PassPrograms::in_compute(const graph::FrameGraph& graph,
                                                       const graph::Pass& pass, const ProgramSources& sources,
                                                       const ShaderContext* shader,
                                                       std::string& why_not) const {
    why_not = fault_of_computing(pass, shader ? shader->pass : nullptr);
    if (!why_not.empty()) return std::nullopt;
    const auto desc_of = [&](graph::TextureHandle texture) -> const gpu::TextureDesc& {
        return graph.textures()[std::size_t(texture.texture)].desc;
    };
    DrawShape shape;
    shape.first_target_unit = int(pass.images.size());
    for (const graph::Target& target : pass.targets) shape.targets.push_back(desc_of(target.texture).format);
    shape.has_levels = std::ranges::any_of(
        pass.reads, [&](const graph::Read& read) { return !read.level && desc_of(read.texture).mips > 1; });
    if (pass.kind == graph::PassKind::instances)
        shape.tile_runs = shader->manifest->tile_list_of(*shader->pass)->runs();
    return in_compute_form(sources, shape, why_not);
}

void PassPrograms::assemble_forms(const graph::FrameGraph& graph, const graph::Pass& pass,
                                  ProgramSources sources, const ShaderContext* shader,
                                  Assembled& texts) const {
    if (texts.faults.has_errors()) {
        texts.own = {std::make_shared<const ProgramSources>(std::move(sources)), pass.images};
        return;
    }
    const int first_unit = int(pass.images.size());
    if (tools_.computes && !sources.is_compute)
        if (auto computes = in_compute(graph, pass, sources, shader, texts.why_drawn)) {
            texts.compute =
                with_loads(graph, pass, std::move(*computes), first_unit + int(pass.targets.size()));
            texts.compute->first_target_unit = first_unit;
        }
    texts.own = with_loads(graph, pass, std::move(sources), first_unit);
}

/// Its program in the form that the driver takes; nullptr where it takes no compute shader of it.
std::shared_ptr<const gpu::Program> PassPrograms::compute_program(Assembled& texts) const {
    if (!texts.compute) return nullptr;
    try {
        return tools_.programs.get(*texts.compute->sources);
    } catch (const gpu::ShaderError& error) {
        const auto& messages = error.messages();
        texts.why_drawn = fmt::format("the driver refuses it as a compute shader{}",
                                      messages.empty() ? "" : ": " + messages.front().text);
        texts.compute.reset();
        return nullptr;
    }
}

void PassPrograms::give_host(const graph::FrameGraph& graph, graph::Pass& pass, const std::string& file,
                             const std::vector<std::string>& defines) const {
    Assembled texts;
    const ProgramSources sources = tools_.programs.host_sources(file, defines);
    if (tools_.computes)
        if (auto computes = in_compute(graph, pass, sources, nullptr, texts.why_drawn))
            texts.compute = {std::make_shared<const ProgramSources>(std::move(*computes)), pass.images,
                             int(pass.images.size())};
    pass.program = compute_program(texts);
    if (!pass.program) pass.program = tools_.programs.get(sources);
    texts.give(pass);
}

bool PassPrograms::is_compiled(const graph::FrameGraph& graph, int pass) const {
    return !graph.pass(pass).program && (tools_.compiles_culled || std::ranges::binary_search(needed_, pass));
}

std::map<int, PassPrograms::Assembled> PassPrograms::assemble_others(
    const graph::FrameGraph& graph, const std::vector<FusedAssembled>& fusions) const {
    std::map<int, Assembled> others;
    const auto is_fused = [&](int pass) {
        return std::ranges::any_of(fusions, [&](const FusedAssembled& fused) {
            return std::ranges::find(fused.passes(), pass) != fused.passes().end();
        });
    };
    for (const auto& [pass, added] : added_) {
        if (is_fused(pass) || !is_compiled(graph, pass)) continue;
        Assembled& texts = others[pass];
        ProgramSources sources = tools_.programs.sources_of(added.shader, texts.faults);
        assemble_forms(graph, graph.pass(pass), std::move(sources), &added.shader, texts);
    }
    return others;
}

/// Takes it that all fusions of the graph link. Another thread's crash would be blamed on the pass that this
/// one is at, so passes of foreign effects are not among them. Without a store nothing reaches this thread,
/// which would compile all of it once more.
void PassPrograms::compile_ahead(const graph::FrameGraph& graph, const std::vector<FusedAssembled>& fusions,
                                 const std::map<int, Assembled>& others) {
    if (tools_.compile_threads < 1 || !tools_.programs.store().is_on() || tools_.programs.is_guarding_loops())
        return;
    graph::FrameGraph with_fusions = graph;
    for (const FusedAssembled& fused : fusions)
        if (!fused.texts.faults.has_errors())
            with_fusions.fuse(fused.passes(), fused.maker.pass(), fused.maker.fusion().targets);
    const graph::CompiledGraph compiled = with_fusions.compile(tools_.shares_memory);
    std::map<int, PassToCompile> missing;  // in the order of the passes
    const auto add = [&](int pass, const Assembled& texts, graph::Pass shape) {
        if (texts.faults.has_errors() || added_.at(pass).step->is_foreign ||
            tools_.programs.has(*texts.form().sources))
            return;
        texts.give(shape);
        missing[pass] = {shape.name, texts.form().sources, graph::shape_of(with_fusions, compiled, shape),
                         std::ranges::binary_search(compiled.passes, pass)};
    };
    for (const FusedAssembled& fused : fusions) add(fused.passes().back(), fused.texts, fused.maker.pass());
    for (const auto& [pass, texts] : others) add(pass, texts, with_fusions.pass(pass));
    if (missing.size() < 2) return;
    std::vector<PassToCompile> passes;
    for (auto& [index, pass] : missing) passes.push_back(std::move(pass));
    ahead_ = std::make_unique<CompileAhead>(tools_.context, tools_.programs, std::move(passes),
                                            tools_.compile_threads);
}

void PassPrograms::finish(graph::FrameGraph& graph, std::vector<BlockBinding>& blocks, int divide_at) {
    const graph::CompiledGraph compiled = graph.compile();
    needed_ = compiled.passes;
    std::vector<FusedAssembled> fusions = assemble_fusions(graph, compiled, divide_at);
    std::map<int, Assembled> others = assemble_others(graph, fusions);
    compile_ahead(graph, fusions, others);
    tools_.context.test_once();  // while the threads compile
    for (FusedAssembled& fused : fusions) fuse(graph, fused, blocks);
    for (const auto& [pass, added] : added_) {
        if (graph.is_fused_away(pass) || !is_compiled(graph, pass)) continue;
        const StatusScope scope(tools_.status, compiling(added, added.shader.pass->name));
        // Of a fusion that failed, nothing has been assembled.
        const auto [assembled, is_new] = others.try_emplace(pass);
        Assembled& texts = assembled->second;
        if (is_new)
            assemble_forms(graph, graph.pass(pass), tools_.programs.sources_of(added.shader, texts.faults),
                           &added.shader, texts);
        const CompileAhead::LinkScope linking(ahead_.get(), graph.pass(pass).name);
        std::shared_ptr<const gpu::Program> program = compute_program(texts);
        if (!program) program = tools_.programs.get(added.shader, *texts.own.sources, texts.faults);
        texts.give(graph.pass(pass));
        graph.pass(pass).program = std::move(program);
    }
}

/// Where the driver does not take the program, its passes stay by themselves, and a fault is reported of
/// theirs.
void PassPrograms::fuse(graph::FrameGraph& graph, FusedAssembled& fused, std::vector<BlockBinding>& blocks) {
    if (fused.texts.faults.has_errors()) return;
    const StatusScope scope(tools_.status, compiling(added_.at(fused.passes().front()), fused.names));
    graph::Pass pass = fused.maker.pass();
    try {
        const CompileAhead::LinkScope linking(ahead_.get(), pass.name);
        pass.program = compute_program(fused.texts);
        if (!pass.program) pass.program = tools_.programs.get(*fused.texts.own.sources);
    } catch (const gpu::ShaderError&) {
        return;
    }
    fused.texts.give(pass);
    point_to_fused(blocks, fused.passes(), fused.maker.program().parts);
    graph.fuse(fused.passes(), std::move(pass), fused.maker.fusion().targets);
}

}  // namespace aftershade
