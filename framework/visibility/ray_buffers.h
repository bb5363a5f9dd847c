// What rays.glsl reads, as buffers of a graph; for the sources of this folder.
#pragma once

#include <vector>

#include "framework/graph/executor.h"
#include "framework/graph/frame_graph.h"
#include "framework/scene/scene_renderer.h"
#include "framework/visibility/gpu_scene.h"
#include "framework/visibility/passes.h"
#include "framework/visibility/sample_rays.h"

namespace aftershade::visibility {

class RayBuffers {
public:
    /// With room for the rays of one sample of this many pixels.
    RayBuffers(graph::FrameGraph& graph, const GpuScene& scene, std::size_t pixels);

    void add_to(graph::Pass& pass) const;
    void set_scene(graph::Executor& executor, const GpuScene& scene) const;
    /// The objects as they stand at the moments of a sample, and its rays. Only here is a hierarchy built.
    /// Sets what the settings have of them.
    void set_sample(graph::Executor& executor, const scene::SceneRenderer& renderer, int sample,
                    const std::vector<scene::World>& moments, const std::vector<GpuRay>& rays,
                    SampleSettings& settings) const;

private:
    graph::BufferHandle nodes_, triangles_, moments_, rays_, top_, objects_;
};

}  // namespace aftershade::visibility
