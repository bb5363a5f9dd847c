#include "framework/visibility/gpu_samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "framework/visibility/sample_rays.h"
#include "framework/visibility/world_buffers.h"

namespace aftershade {
std::string_view visibility_light_samples_shader();        // light_samples.comp with alpha_off.glsl
std::string_view visibility_light_samples_alpha_shader();  // and with alpha_on.glsl
}  // namespace aftershade

namespace aftershade::visibility {

using glm::vec4;
using gpu::Access;

namespace {

/// What light needs of a triangle's corners.
struct GpuCorners {
    std::array<vec4, 3> normals{};
    vec4 v_material{0};
};

/// In the order of gpu_sources().
std::vector<GpuCorners> corners_of(const scene::Scene& scene) {
    std::vector<GpuCorners> corners;
    for (const auto& [object, triangle] : gpu_sources(scene)) {
        const scene::Object& of = scene.objects[object];
        const scene::Mesh& mesh = scene.meshes[std::size_t(of.shape.mesh)];
        GpuCorners& own = corners.emplace_back();
        for (int i = 0; i < 3; ++i) {
            const scene::Vertex& vertex = mesh.vertices[mesh.triangles[triangle][std::size_t(i)]];
            own.normals[std::size_t(i)] = with(vertex.normal, vertex.uv.x);
            own.v_material[i] = float(vertex.uv.y);
        }
        own.v_material.w = std::bit_cast<float>(std::uint32_t(scene.material_at(int(object), triangle)));
    }
    return corners;
}

/// One pass: the light of one sample of each pixel of a band, added to that of the samples before it.
class LightSamplesGraph {
public:
    LightSamplesGraph(Passes& passes, const scene::SceneRenderer& renderer, const SampleSettings& settings,
                      std::size_t pixels, std::size_t max_buffer_bytes)
        : passes_(passes),
          scene_path_(renderer.scene().path.string()),
          settings_(settings),
          corners_(corners_of(renderer.scene())),
          world_(graph_, renderer,
                 {.light = true,
                  .moments = scene::SceneRenderer::kMomentsOfSample,
                  .max_bytes = max_buffer_bytes}),
          executor_(executor_of(passes, make_graph(pixels))) {
        world_.set(executor_);
        set(executor_, corners_in_, corners_);
    }

    void light(int sample, const std::vector<scene::World>& moments, const std::vector<GpuRay>& rays) {
        settings_.pixel_count = std::uint32_t(rays.size());
        settings_.sample_index = std::uint32_t(sample);
        world_.set_moments(executor_, 0, moments);
        set(executor_, rays_, rays);
        executor_.set_uniforms(0, 0, bytes_of(settings_));
        passes_.run(executor_);
        check_loops(executor_, unfinished_, scene_path_);
    }
    /// The sum of the samples' light for each pixel of the band; w: how many of them met something.
    std::vector<vec4> sums() { return values_of<vec4>(executor_, sums_); }

private:
    graph::FrameGraph make_graph(std::size_t pixels) {
        rays_ = graph_.import_buffer("rays", {pixels * sizeof(GpuRay)});
        corners_in_ = graph_.import_buffer("corners", room_for(corners_));
        graph::Pass pass = passes_.pass(
            "visibility.light_samples",
            world_.has_alpha() ? visibility_light_samples_alpha_shader() : visibility_light_samples_shader(),
            group_count(pixels));
        pass.uniforms = {{0, bytes_of(settings_)}};
        world_.add_to(pass);
        pass.buffers.push_back({rays_, 2, Access::read});
        pass.buffers.push_back({corners_in_, 3, Access::read});
        // It also reads what its run for the sample before has left there, which is not of this frame.
        pass.buffers.push_back({graph_.create_buffer("sums", {pixels * sizeof(vec4)}), 6, Access::write});
        const std::size_t sums = pass.buffers.size() - 1;
        const graph::Written written = add_with_loops(graph_, std::move(pass));
        sums_ = written.buffers[sums];
        unfinished_ = written.buffers.back();
        graph_.keep(sums_);
        return std::move(graph_);
    }

    Passes& passes_;
    std::string scene_path_;
    SampleSettings settings_;
    std::vector<GpuCorners> corners_;
    graph::FrameGraph graph_;  // until the executor has it
    WorldBuffers world_;
    graph::BufferHandle rays_, corners_in_, sums_, unfinished_;
    graph::Executor executor_;  // made of all the above
};

}  // namespace

scene::LitSamples light_samples(Passes& passes, const scene::SceneRenderer& renderer, int frame,
                                const scene::VisibilitySettings& settings, std::size_t max_buffer_bytes) {
    const auto width = std::size_t(renderer.width_px());
    const scene::TruthSettings truth = truth_of(settings);
    const scene::World now = renderer.world_at(frame, frame);
    const SampleSettings values = sample_settings(renderer, now.state().camera, settings.samples);
    const Bands bands(renderer.width_px(), renderer.height_px(), width * sizeof(GpuRay), 1, max_buffer_bytes);
    LightSamplesGraph graph(passes, renderer, values, width * std::size_t(bands.rows), max_buffer_bytes);
    scene::LitSamples lit(renderer.width_px(), renderer.height_px());
    bands.for_each([&](int first, int rows) {
        for (int sample = 0; sample < settings.samples; ++sample) {
            const std::vector<scene::World> worlds = renderer.moments_of(frame, truth, sample);
            graph.light(sample, worlds, rays_of_band(renderer, frame, settings, sample, worlds, first, rows));
        }
        const std::vector<vec4> sums = graph.sums();
        for (std::size_t i = 0; i < width * std::size_t(rows); ++i) {
            const std::size_t pixel = std::size_t(first) * width + i;
            lit.sums[pixel] = glm::dvec3(sums[i]);
            lit.shadings[pixel] = lit.met[pixel] = std::uint32_t(sums[i].w);
        }
    });
    return lit;
}

}  // namespace aftershade::visibility
