// From steps and their parameters to the passes of a frame graph.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "framework/effect/param_resources.h"
#include "framework/effect/pass_program.h"
#include "framework/graph/frame_graph.h"
#include "framework/pipeline/native_steps.h"
#include "framework/pipeline/param_upload.h"
#include "framework/pipeline/pipeline.h"

namespace aftershade {

/// Where the executor finds what changes from frame to frame.
struct BoundPass {
    int step = 0;
    int pass = 0;          ///< in the graph
    bool mixes = false;    ///< the host's own pass: its block is the mix's
    bool is_host = false;  ///< a copy of the host's own: it has no blocks
};

/// A texture or a buffer that a parameter fills.
struct BoundParam {
    int step = 0;
    const ParamSpec* spec = nullptr;
    graph::TextureHandle texture;
    graph::BufferHandle buffer;
};

/// One image of a capture that the graph imports.
struct ImportKey {
    std::string role;
    int offset = 0;  ///< -1, 0, +1: of which capture
    auto operator<=>(const ImportKey&) const = default;
};

struct StepBuild;

/// Adds the passes of one step after the other to a graph.
class GraphBuilder {
public:
    using Textures = std::map<std::string, graph::TextureHandle>;

    GraphBuilder(ProgramCache& programs, StepFiles& files, const NativeSteps& natives,
                 const Pipeline& pipeline, const FrameInputs& frame);

    /// Adds step `index`, after those before it. Throws Error(ExitCode::effect) where a pass reads, or the
    /// step outputs, what no pass has written with these parameters.
    void add_step(int index, const ParamSet& params);

    /// Textures and outputs of a step that was added, by name, as they are after its last pass.
    const Textures& textures_of(int step) const { return steps_.at(std::size_t(step)); }

    graph::FrameGraph graph;
    std::map<ImportKey, graph::TextureHandle> imports;
    std::map<int, graph::TextureHandle> mask_files;  ///< by step
    std::vector<BoundPass> passes;
    std::vector<BoundParam> bound_params;
    std::map<int, std::map<std::string, graph::TextureHandle>> native_tables;  ///< by step and name

private:
    graph::TextureHandle import(const std::string& role, int offset = 0);
    graph::TextureHandle resolve(const InputSource& source, int offset = 0);
    void declare(StepBuild& build);
    void require_written(const StepBuild& build, const InputSpec& input, graph::TextureHandle handle) const;
    /// An input is level 0 of a texture that has more.
    int input_level(graph::TextureHandle handle) const;
    void declare_texture(StepBuild& build, const TextureSpec& spec);
    void declare_buffer(StepBuild& build, const BufferSpec& spec);
    void declare_params(StepBuild& build);
    void add_pass(StepBuild& build, const PassSpec& spec);
    void add_turn(StepBuild& build, const PassSpec& spec, int turn, int turns);
    void add_clear(StepBuild& build, const PassSpec& spec);
    void add_mix(StepBuild& build);
    void add_copy(StepBuild& build, const std::string& name, graph::TextureHandle from,
                  graph::TextureHandle to);
    void keep_histories(StepBuild& build);
    std::array<float, 4> tile_grid_size(const StepBuild& build, const PassSpec& spec,
                                        const PassBindings& bindings) const;
    graph::TextureHandle write_target(const StepBuild& build, const PassBindings& bindings,
                                      const std::string& name, const std::string& pass);
    void set_kind(const StepBuild& build, const PassSpec& spec, graph::Pass& pass) const;

    ProgramCache& programs_;
    StepFiles& files_;
    const NativeSteps& natives_;
    const Pipeline& pipeline_;
    FrameInputs frame_;
    int width_ = 0;
    int height_ = 0;
    std::vector<Textures> steps_;
};

/// Extent of a grid over a working grid of width x height px.
std::pair<int, int> grid_size(const GridSpec& grid, const ParamSet& params, int width, int height);
/// One number for all four, or four.
std::array<double, 4> four_values(const std::vector<double>& values);
/// A count's number, or the value of the int parameter that it names.
int count_value(const CountSpec& count, const ParamSet& params);

}  // namespace aftershade
