#include "framework/visibility/gpu_visibility.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "framework/visibility/bands.h"
#include "framework/visibility/gpu_scene.h"
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
    TraceGraph(Passes& passes, const GpuScene& scene, const SampleSettings& settings, std::size_t pixels,
               std::string scene_path)
        : passes_(passes),
          settings_(settings),
          scene_path_(std::move(scene_path)),
          executor_(executor_of(passes, make_graph(scene, pixels))) {
        set(executor_, nodes_, scene.nodes);
        set(executor_, triangles_, scene.triangles);
    }

    void trace(int sample, const std::vector<vec4>& moments, const std::vector<GpuRay>& rays) {
        settings_.pixel_count = std::uint32_t(rays.size());
        settings_.sample_index = std::uint32_t(sample);
        set(executor_, moments_, moments);
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
    graph::FrameGraph make_graph(const GpuScene& scene, std::size_t pixels) {
        graph::FrameGraph graph;
        nodes_ = graph.import_buffer("nodes", room_for(scene.nodes));
        triangles_ = graph.import_buffer("triangles", room_for(scene.triangles));
        moments_ = graph.import_buffer("moments", {std::size_t(scene::SceneRenderer::kMomentsOfSample) *
                                                   settings_.object_count * 3 * sizeof(vec4)});
        rays_ = graph.import_buffer("rays", {pixels * sizeof(GpuRay)});
        graph::Pass trace = passes_.pass("visibility.trace", visibility_trace_shader(), group_count(pixels));
        trace.uniforms = {{0, bytes_of(settings_)}};
        trace.buffers = {
            {nodes_, 0, Access::read},
            {triangles_, 1, Access::read},
            {moments_, 2, Access::read},
            {rays_, 3, Access::read},
            {graph.create_buffer("ids", {pixels * settings_.sample_count * sizeof(std::uint32_t)}), 4,
             Access::write}};
        const int ids = int(trace.buffers.size()) - 1;
        const graph::Written written = add_with_loops(graph, std::move(trace));
        ids_ = written.buffers[std::size_t(ids)];
        unfinished_ = written.buffers.back();
        graph.keep(ids_);
        return graph;
    }

    Passes& passes_;
    SampleSettings settings_;
    graph::BufferHandle nodes_, triangles_, moments_, rays_, ids_, unfinished_;
    std::string scene_path_;
    graph::Executor executor_;  // made of all the above
};

}  // namespace

std::vector<std::uint32_t> trace_ids(Passes& passes, const scene::SceneRenderer& renderer,
                                     const scene::ShadingGrids& grids, int frame,
                                     const scene::VisibilitySettings& settings,
                                     std::size_t max_buffer_bytes) {
    const auto width = std::size_t(renderer.width_px()), samples = std::size_t(settings.samples);
    const scene::TruthSettings truth = truth_of(settings);
    const GpuScene scene = make_gpu_scene(renderer, grids, frame);
    const SampleSettings values =
        sample_settings(renderer, scene, grids.reference().camera, settings.samples);
    const Bands bands(renderer.width_px(), renderer.height_px(),
                      width * std::max(samples * sizeof(std::uint32_t), sizeof(GpuRay)), 1, max_buffer_bytes);
    TraceGraph graph(passes, scene, values, width * std::size_t(bands.rows), renderer.scene().path.string());
    std::vector<std::uint32_t> ids;
    bands.for_each([&](int first, int rows) {
        for (int sample = 0; sample < settings.samples; ++sample) {
            const std::vector<scene::World> worlds = renderer.moments_of(frame, truth, sample);
            graph.trace(sample, make_moments(worlds),
                        rays_of_band(renderer, frame, settings, sample, worlds, first, rows));
        }
        const std::vector<std::uint32_t> band = graph.ids();
        ids.insert(ids.end(), band.begin(), band.end());
    });
    return ids;
}

}  // namespace aftershade::visibility
