// From a look's steps to a frame graph, with the way back from its parts to the steps.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "framework/base/status.h"
#include "framework/effect/param_reader.h"
#include "framework/effect/pass_program.h"
#include "framework/graph/frame_graph.h"
#include "framework/look/pixel_shape.h"
#include "framework/render/built_graph.h"
#include "framework/render/graph_bindings.h"
#include "framework/render/graph_key.h"
#include "framework/render/pass_programs.h"
#include "framework/render/renderer_options.h"
#include "framework/render/step_files.h"

namespace aftershade {

/// Tools that make every graph of a pipeline. [refers to what the caller keeps]
struct GraphTools {
    gpu::Context& context;
    ProgramCache& programs;
    StepFiles& files;
    const RendererOptions& options;
    StatusWriter* status = nullptr;  ///< receives which pass is compiled; may be null
    bool primes = false;             ///< what the first draws compile is made before them
};

/// Throws Error(ErrorKind::effect) where a pass reads, or a step outputs, what no pass has written with these
/// parameters; Error(ErrorKind::usage) for a tap that no pass writes, and for files.
std::unique_ptr<BuiltGraph> build_graph(const GraphTools& tools, const GraphFrame& frame);

struct StepBuild;

/// The binding of the blocks in glsl/host/square_pixels.frag and window.frag.
inline constexpr int kStretchBinding = 0;
/// The passes that convert between grids, and their targets, are named after the texture that they read, with
/// one of these suffixes.
inline constexpr const char* kToSquarePixels = "@square pixels";
inline constexpr const char* kToStoredPixels = "@stored pixels";
inline constexpr const char* kToDisplayWindow = "@display window";
inline constexpr const char* kToDataWindow = "@data window";

/// Adds the passes of one step after the other to a graph.
class GraphBuilder {
public:
    GraphBuilder(const GraphTools& tools, const GraphFrame& frame);

    std::unique_ptr<BuiltGraph> build();

private:
    void add_step(int index);
    std::vector<std::string> present_inputs(int index);
    graph::TextureHandle import(const RoleId& role, int offset = 0);
    graph::TextureHandle resolve(const InputSource& source, int offset = 0);
    /// What the texels of a step's images are: of square pixels or the capture's, in the display window or
    /// the data's.
    struct Grid {
        bool is_square = false, is_display = false;
        bool operator==(const Grid&) const = default;
    };
    Grid grid_of(int step) const;
    std::pair<int, int> size_of(const Grid& grid);
    void use_grid_of(int step);
    graph::TextureHandle converted(graph::TextureHandle handle, const InputSource& source, const Grid& from,
                                   const Grid& to);
    /// `handle`, which is `source`, on the grid that is in use.
    graph::TextureHandle on_grid(graph::TextureHandle handle, const InputSource& source);
    void declare(StepBuild& build);
    void require_written(const StepBuild& build, const InputSpec& input, graph::TextureHandle handle) const;
    /// An input is level 0 of a texture that has more.
    std::optional<int> input_level(graph::TextureHandle handle) const;
    bool shows_undrawn(const StepBuild& build, const TextureSpec& spec) const;
    void declare_texture(StepBuild& build, const TextureSpec& spec);
    void declare_buffer(StepBuild& build, const BufferSpec& spec);
    void declare_params(StepBuild& build);
    void declare_native_tables(StepBuild& build);
    void add_pass(StepBuild& build, const PassSpec& spec);
    void add_turn(StepBuild& build, const PassSpec& spec, int turn, int turns);
    void add_clear(StepBuild& build, const PassSpec& spec);
    void add_copy_pass(StepBuild& build, const PassSpec& spec);
    void add_mix(StepBuild& build);
    graph::TextureHandle mask_of(const StepBuild& build);
    void add_copy(StepBuild& build, const std::string& name, graph::TextureHandle from,
                  graph::TextureHandle to);
    void keep_histories(StepBuild& build);
    std::array<float, 2> listed_size(const StepBuild& build, const TileListSpec& list) const;
    std::vector<std::byte> tiles_block(const StepBuild& build, const PassSpec& spec,
                                       const PassBindings& bindings) const;
    std::array<float, 4> tile_grid_size(const StepBuild& build, const PassSpec& spec,
                                        const PassBindings& bindings) const;
    graph::TextureHandle write_target(const StepBuild& build, const PassBindings& bindings,
                                      const std::string& name, const std::string& pass);
    void set_kind(const StepBuild& build, const PassSpec& spec, graph::Pass& pass) const;
    /// Gives the pass that is added next a block that is filled for each frame.
    void bind_block(const StepBuild& build, BlockKind kind, graph::Pass& pass);
    void keep_results();
    void keep_taps();
    void keep_statistics();

    const GraphTools& tools_;
    GraphFrameReader frame_;
    const Pipeline& pipeline_;
    const GraphFrameReader::SquareGrid square_;
    const SquareSteps square_steps_;
    Grid grid_;               // in use, of the step that is added
    bool is_single_ = false;  // whether the step runs once a frame
    int width_ = 0;           // of that grid
    int height_ = 0;
    graph::FrameGraph graph_;
    PassPrograms programs_;
    std::unique_ptr<BuiltGraph> built_;
    std::map<std::pair<RoleId, int>, graph::TextureHandle> imports_;  // by role and offset
    /// By texture, version, is_single_ and the grid that it is on.
    std::map<std::tuple<int, int, bool, bool, bool>, graph::TextureHandle> converted_;
    std::map<int, graph::TextureHandle> masks_;  // by step
    std::vector<ParamBinding> params_;
    std::vector<NativeTableBinding> native_tables_;
    std::vector<BlockBinding> blocks_;
};

/// Extent of a grid over a working grid of width x height px.
std::pair<int, int> grid_size(const GridSpec& grid, const ParamReader& params, int width, int height);
/// Defines of glsl/host/copy.frag.
std::vector<std::string> copy_defines(gpu::TextureFormat format);
/// One number for all four, or four.
std::array<double, 4> four_values(const std::vector<double>& values);
/// A count's number, or the value of the int parameter that it names.
int count_value(const CountSpec& count, const ParamReader& params);

}  // namespace aftershade
