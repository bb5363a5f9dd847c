#include "framework/visibility/world_buffers.h"

#include <algorithm>
#include <utility>

#include "framework/visibility/gpu_textures.h"

namespace aftershade::visibility {

using glm::vec4;
using gpu::Access;

namespace {

constexpr int kUniforms = 1;  // as world.glsl has it

}  // namespace

WorldBuffers::WorldBuffers(graph::FrameGraph& graph, const scene::SceneRenderer& renderer,
                           const WorldNeeds& needs)
    : renderer_(renderer), has_lights_(needs.light) {
    const scene::Scene& scene = renderer.scene();
    GpuScene gpu = make_gpu_scene(renderer);
    meshes_ = std::move(gpu.meshes);
    GpuLooks looks = gpu_looks(scene, gpu.objects, needs.light, needs.max_bytes);
    looks_ = std::move(looks.words);
    GpuExtras extras = gpu_extras(renderer, needs.light, needs.tangents_at, needs.max_bytes);
    extras_ = std::move(extras.values);
    layout_.triangles_at = gpu.triangles_at;
    layout_.object_count = std::uint32_t(scene.objects.size());
    layout_.materials_at = looks.materials_at;
    layout_.extras_stride = extras.stride;
    layout_.extras_uvs = extras.uvs_at;
    meshes_in_ = graph.import_buffer("meshes", room_for(meshes_));
    // A hierarchy has fewer than twice as many nodes as items.
    const std::size_t rows = std::max(scene.objects.size(), std::size_t(1)) * (needs.moments * 3 + 4) +
                             (needs.light ? needs.moments * scene.lights.size() * kLightRows : 0);
    moving_in_ = graph.import_buffer("moving", {rows * sizeof(vec4)});
    looks_in_ = graph.import_buffer("looks", room_for(looks_));
    extras_in_ = graph.import_buffer("extras", room_for(extras_));
}

bool WorldBuffers::has_alpha() const {
    for (std::size_t i = 0; i < renderer_.scene().objects.size(); ++i)
        if (renderer_.geometry().alpha_of(i).has_holes || renderer_.geometry().alpha_of(i).is_mixed)
            return true;
    return false;
}

/// Bindings as world.glsl has them.
void WorldBuffers::add_to(graph::Pass& pass) const {
    pass.buffers.push_back({meshes_in_, 0, Access::read});
    pass.buffers.push_back({moving_in_, 1, Access::read});
    pass.buffers.push_back({looks_in_, 4, Access::read});
    pass.buffers.push_back({extras_in_, 5, Access::read});
    pass.uniforms.push_back({kUniforms, bytes_of(layout_)});
}

void WorldBuffers::set(graph::Executor& executor) const {
    visibility::set(executor, meshes_in_, meshes_);
    visibility::set(executor, looks_in_, looks_);
    visibility::set(executor, extras_in_, extras_);
}

void WorldBuffers::set_moments(graph::Executor& executor, int pass,
                               const std::vector<scene::World>& moments) {
    std::vector<vec4> rows = make_moments(moments);
    const std::vector<GpuNode> top = make_top(renderer_, moments);
    layout_.top_at = std::uint32_t(rows.size());
    layout_.top_count = std::uint32_t(top.size());
    for (const GpuNode& node : top) rows.insert(rows.end(), {node.low_skip, node.high_items});
    layout_.lights_at = std::uint32_t(rows.size());
    if (has_lights_)
        for (const scene::World& world : moments) add_lights(rows, world.scene(), world.state());
    visibility::set(executor, moving_in_, rows);
    executor.set_uniforms(pass, kUniforms, bytes_of(layout_));
}

}  // namespace aftershade::visibility
