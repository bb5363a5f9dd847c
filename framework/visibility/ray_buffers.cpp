#include "framework/visibility/ray_buffers.h"

#include <algorithm>
#include <cstdint>

namespace aftershade::visibility {

using gpu::Access;

RayBuffers::RayBuffers(graph::FrameGraph& graph, const GpuScene& scene, std::size_t pixels) {
    const std::size_t objects = std::max(scene.objects.size(), std::size_t(1));
    nodes_ = graph.import_buffer("nodes", room_for(scene.nodes));
    triangles_ = graph.import_buffer("triangles", room_for(scene.triangles));
    moments_ = graph.import_buffer(
        "moments", {std::size_t(scene::SceneRenderer::kMomentsOfSample) * objects * 3 * sizeof(glm::vec4)});
    rays_ = graph.import_buffer("rays", {pixels * sizeof(GpuRay)});
    top_ = graph.import_buffer("top", {2 * objects * sizeof(GpuNode)});
    objects_ = graph.import_buffer("objects", room_for(scene.objects));
}

/// Bindings as rays.glsl has them.
void RayBuffers::add_to(graph::Pass& pass) const {
    pass.buffers.push_back({nodes_, 0, Access::read});
    pass.buffers.push_back({triangles_, 1, Access::read});
    pass.buffers.push_back({moments_, 2, Access::read});
    pass.buffers.push_back({rays_, 3, Access::read});
    pass.buffers.push_back({top_, 11, Access::read});
    pass.buffers.push_back({objects_, 12, Access::read});
}

void RayBuffers::set_scene(graph::Executor& executor, const GpuScene& scene) const {
    set(executor, nodes_, scene.nodes);
    set(executor, triangles_, scene.triangles);
    set(executor, objects_, scene.objects);
}

void RayBuffers::set_sample(graph::Executor& executor, const scene::SceneRenderer& renderer, int sample,
                            const std::vector<scene::World>& moments, const std::vector<GpuRay>& rays,
                            SampleSettings& settings) const {
    const std::vector<GpuNode> top = make_top(renderer, moments);
    settings.top_count = std::uint32_t(top.size());
    settings.pixel_count = std::uint32_t(rays.size());
    settings.sample_index = std::uint32_t(sample);
    set(executor, top_, top);
    set(executor, moments_, make_moments(moments));
    set(executor, rays_, rays);
}

}  // namespace aftershade::visibility
