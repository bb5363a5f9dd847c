#include "framework/visibility/gpu_visibility.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "framework/visibility/bands.h"
#include "framework/visibility/gpu_scene.h"
#include "framework/visibility/ray_buffers.h"
#include "framework/visibility/sample_rays.h"

namespace aftershade {
std::string_view visibility_trace_shader();  // trace.comp
}  // namespace aftershade

namespace aftershade::visibility {

using glm::vec4;
using gpu::Access;

namespace {

/// One pass: what one sample of each pixel of a band meets.
class TraceGraph {
public:
    TraceGraph(Passes& passes, const scene::SceneRenderer& renderer, const std::vector<GpuGrid>& grids,
               const SampleSettings& settings, std::size_t pixels)
        : passes_(passes),
          renderer_(renderer),
          scene_(make_gpu_scene(renderer)),
          settings_(settings),
          rays_(graph_, scene_, pixels),
          executor_(executor_of(passes, make_graph(grids, pixels))) {
        rays_.set_scene(executor_, scene_);
        set(executor_, grids_, grids);
    }

    void trace(int sample, const std::vector<scene::World>& moments, const std::vector<GpuRay>& rays) {
        rays_.set_sample(executor_, renderer_, sample, moments, rays, settings_);
        executor_.set_uniforms(0, 0, bytes_of(settings_));
        passes_.run(executor_);
        check_loops(executor_, unfinished_, renderer_.scene().path.string());
    }
    /// Of the band whose samples were traced.
    std::vector<std::uint32_t> ids() {
        std::vector<std::uint32_t> ids = values_of<std::uint32_t>(executor_, ids_);
        ids.resize(std::size_t(settings_.pixel_count) * settings_.sample_count);
        return ids;
    }

private:
    graph::FrameGraph make_graph(const std::vector<GpuGrid>& grids, std::size_t pixels) {
        graph::Pass trace = passes_.pass("visibility.trace", visibility_trace_shader(), group_count(pixels));
        trace.uniforms = {{0, bytes_of(settings_)}};
        rays_.add_to(trace);
        grids_ = graph_.import_buffer("grids", room_for(grids));
        trace.buffers.push_back({grids_, 5, Access::read});
        trace.buffers.push_back(
            {graph_.create_buffer("ids", {pixels * settings_.sample_count * sizeof(std::uint32_t)}), 4,
             Access::write});
        const std::size_t ids = trace.buffers.size() - 1;
        const graph::Written written = add_with_loops(graph_, std::move(trace));
        ids_ = written.buffers[ids];
        unfinished_ = written.buffers.back();
        graph_.keep(ids_);
        return std::move(graph_);
    }

    Passes& passes_;
    const scene::SceneRenderer& renderer_;
    GpuScene scene_;
    SampleSettings settings_;
    graph::FrameGraph graph_;  // until the executor has it
    RayBuffers rays_;
    graph::BufferHandle grids_, ids_, unfinished_;
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
    TraceGraph graph(passes, renderer, gpu_grids, values, width * std::size_t(bands.rows));
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
