// What world.glsl reads, as buffers of a graph; for the sources of this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/graph/executor.h"
#include "framework/graph/frame_graph.h"
#include "framework/scene/scene_renderer.h"
#include "framework/visibility/gpu_scene.h"
#include "framework/visibility/passes.h"

namespace aftershade::visibility {

/// What a pass needs of the scene beside its triangles.
struct WorldNeeds {
    bool light = false;  ///< lights, all materials and tangents; else what decides about opacity alone
    const scene::SceneState* tangents_at = nullptr;  ///< tangents in world space then; null: in the objects'
    std::size_t moments = 1;                         ///< at most
    std::size_t max_bytes = 0;  ///< of textures, and of what triangles have beside their corners
};

class WorldBuffers {
public:
    /// Throws Error(ErrorKind::usage) for more than 2^20 triangles, and for more than WorldNeeds::max_bytes.
    WorldBuffers(graph::FrameGraph& graph, const scene::SceneRenderer& renderer, const WorldNeeds& needs);

    /// Whether shaders need alpha_on.glsl; else alpha_off.glsl is enough.
    bool has_alpha() const;
    /// The buffers and the uniforms of world.glsl.
    void add_to(graph::Pass& pass) const;
    /// What stays, once.
    void set(graph::Executor& executor) const;
    /// The objects and lights as they stand at these moments, for a pass. Only here is a hierarchy built.
    void set_moments(graph::Executor& executor, int pass, const std::vector<scene::World>& moments);

private:
    /// As world.glsl has it.
    struct Layout {
        std::uint32_t triangles_at = 0;
        std::uint32_t object_count = 0;
        std::uint32_t top_at = 0;
        std::uint32_t top_count = 0;
        std::uint32_t lights_at = 0;
        std::uint32_t materials_at = 0;
        std::uint32_t extras_stride = 0;
        std::uint32_t extras_uvs = 0;
    };
    const scene::SceneRenderer& renderer_;
    bool has_lights_;
    Layout layout_;
    std::vector<glm::vec4> meshes_, extras_;
    std::vector<std::uint32_t> looks_;
    graph::BufferHandle meshes_in_, moving_in_, looks_in_, extras_in_;
};

}  // namespace aftershade::visibility
