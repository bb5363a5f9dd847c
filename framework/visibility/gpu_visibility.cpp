#include "framework/visibility/gpu_visibility.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "framework/visibility/bands.h"
#include "framework/visibility/gpu_scene.h"
#include "framework/visibility/sample_rays.h"
#include "framework/visibility/world_buffers.h"

namespace aftershade {
std::string_view visibility_trace_shader();        // trace.comp with alpha_off.glsl
std::string_view visibility_trace_alpha_shader();  // and with alpha_on.glsl
}  // namespace aftershade

namespace aftershade::visibility {

using glm::vec4;
using gpu::Access;

namespace {

/// One pass: what one sample of each pixel of a band meets.
class TraceGraph {
public:
    TraceGraph(Passes& passes, const scene::SceneRenderer& renderer, const std::vector<GpuGrid>& grids,
               const SampleSettings& settings, std::size_t pixels, std::size_t max_buffer_bytes)
        : passes_(passes),
          scene_path_(renderer.scene().path.string()),
          settings_(settings),
          world_(graph_, renderer,
                 {.moments = scene::SceneRenderer::kMomentsOfSample, .max_bytes = max_buffer_bytes}),
          executor_(executor_of(passes, make_graph(grids, pixels))) {
        world_.set(executor_);
        set(executor_, grids_, grids);
    }

    void trace(int sample, const std::vector<scene::World>& moments, const std::vector<GpuRay>& rays) {
        settings_.pixel_count = std::uint32_t(rays.size());
        settings_.sample_index = std::uint32_t(sample);
        world_.set_moments(executor_, 0, moments);
        set(executor_, rays_, rays);
        executor_.set_uniforms(0, 0, bytes_of(settings_));
        passes_.run(executor_);
        check_loops(executor_, unfinished_, scene_path_);
    }
    /// Of the band whose samples were traced.
    std::vector<std::uint32_t> ids() {
        std::vector<std::uint32_t> ids = values_of<std::uint32_t>(executor_, ids_);
        ids.resize(std::size_t(settings_.pixel_count) * settings_.sample_count);
        return ids;
    }

private:
    graph::FrameGraph make_graph(const std::vector<GpuGrid>& grids, std::size_t pixels) {
        graph::Pass trace =
            passes_.pass("visibility.trace",
                         world_.has_alpha() ? visibility_trace_alpha_shader() : visibility_trace_shader(),
                         group_count(pixels));
        trace.uniforms = {{0, bytes_of(settings_)}};
        world_.add_to(trace);
        rays_ = graph_.import_buffer("rays", {pixels * sizeof(GpuRay)});
        trace.buffers.push_back({rays_, 2, Access::read});
        grids_ = graph_.import_buffer("grids", room_for(grids));
        trace.buffers.push_back({grids_, 3, Access::read});
        trace.buffers.push_back(
            {graph_.create_buffer("ids", {pixels * settings_.sample_count * sizeof(std::uint32_t)}), 6,
             Access::write});
        const std::size_t ids = trace.buffers.size() - 1;
        const graph::Written written = add_with_loops(graph_, std::move(trace));
        ids_ = written.buffers[ids];
        unfinished_ = written.buffers.back();
        graph_.keep(ids_);
        return std::move(graph_);
    }

    Passes& passes_;
    std::string scene_path_;
    SampleSettings settings_;
    graph::FrameGraph graph_;  // until the executor has it
    WorldBuffers world_;
    graph::BufferHandle rays_, grids_, ids_, unfinished_;
    graph::Executor executor_;  // made of all the above
};

}  // namespace

std::vector<std::uint32_t> trace_ids(Passes& passes, const scene::SceneRenderer& renderer,
                                     const scene::ShadingGrids& grids, int frame,
                                     const scene::VisibilitySettings& settings,
                                     std::size_t max_buffer_bytes) {
    const auto width = std::size_t(renderer.width_px()), samples = std::size_t(settings.samples);
    const scene::TruthSettings truth = truth_of(settings);
    const std::vector<GpuGrid> gpu_grids = make_gpu_grids(renderer.scene(), grids);
    const SampleSettings values = sample_settings(renderer, grids.reference().camera, settings.samples);
    const Bands bands(renderer.width_px(), renderer.height_px(),
                      width * std::max(samples * sizeof(std::uint32_t), sizeof(GpuRay)), 1, max_buffer_bytes);
    TraceGraph graph(passes, renderer, gpu_grids, values, width * std::size_t(bands.rows), max_buffer_bytes);
    std::vector<std::uint32_t> ids;
    bands.for_each([&](int first, int rows) {
        for (int sample = 0; sample < settings.samples; ++sample) {
            const std::vector<scene::World> worlds = renderer.moments_of(frame, truth, sample);
            graph.trace(sample, worlds, rays_of_band(renderer, frame, settings, sample, worlds, first, rows));
        }
        const std::vector<std::uint32_t> band = graph.ids();
        ids.insert(ids.end(), band.begin(), band.end());
    });
    return ids;
}

}  // namespace aftershade::visibility
