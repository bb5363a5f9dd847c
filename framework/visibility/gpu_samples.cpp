#include "framework/visibility/gpu_samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "framework/visibility/light_scene.h"
#include "framework/visibility/ray_buffers.h"
#include "framework/visibility/sample_rays.h"

namespace aftershade {
std::string_view visibility_light_samples_shader();  // light_samples.comp
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

/// The lights at all moments, those of a moment side by side.
std::vector<GpuLight> lights_at(const std::vector<scene::World>& moments) {
    std::vector<GpuLight> lights;
    for (const scene::World& world : moments)
        for (const GpuLight& light : gpu_lights(world.scene(), world.state())) lights.push_back(light);
    return lights;
}

/// One pass: the light of one sample of each pixel of a band, added to that of the samples before it.
class LightSamplesGraph {
public:
    LightSamplesGraph(Passes& passes, const scene::SceneRenderer& renderer, const SampleSettings& settings,
                      std::size_t pixels, std::size_t max_buffer_bytes)
        : passes_(passes),
          renderer_(renderer),
          scene_(make_gpu_scene(renderer)),
          settings_(settings),
          materials_(gpu_materials(renderer.scene(), max_buffer_bytes)),
          corners_(corners_of(renderer.scene())),
          tangents_(gpu_tangents(renderer.scene(), gpu_sources(renderer.scene()))),
          rays_(graph_, scene_, pixels),
          executor_(executor_of(passes, make_graph(pixels))) {
        rays_.set_scene(executor_, scene_);
        set(executor_, materials_in_, materials_.materials);
        set(executor_, textures_in_, materials_.textures);
        set(executor_, tangents_in_, tangents_);
        set(executor_, corners_in_, corners_);
    }

    void light(int sample, const std::vector<scene::World>& moments, const std::vector<GpuRay>& rays) {
        rays_.set_sample(executor_, renderer_, sample, moments, rays, settings_);
        set(executor_, lights_in_, lights_at(moments));
        executor_.set_uniforms(0, 0, bytes_of(settings_));
        passes_.run(executor_);
        check_loops(executor_, unfinished_, renderer_.scene().path.string());
    }
    /// The sum of the samples' light for each pixel of the band; w: how many of them met something.
    std::vector<vec4> sums() { return values_of<vec4>(executor_, sums_); }

private:
    graph::FrameGraph make_graph(std::size_t pixels) {
        constexpr std::size_t kMoments = scene::SceneRenderer::kMomentsOfSample;
        materials_in_ = graph_.import_buffer("materials", room_for(materials_.materials));
        textures_in_ = graph_.import_buffer("textures", room_for(materials_.textures));
        tangents_in_ = graph_.import_buffer("tangents", room_for(tangents_));
        lights_in_ = graph_.import_buffer(
            "lights", {kMoments * std::max(settings_.light_count, 1u) * sizeof(GpuLight)});
        corners_in_ = graph_.import_buffer("corners", room_for(corners_));
        graph::Pass pass =
            passes_.pass("visibility.light_samples", visibility_light_samples_shader(), group_count(pixels));
        pass.uniforms = {{0, bytes_of(settings_)}};
        rays_.add_to(pass);
        pass.buffers.push_back({materials_in_, 4, Access::read});
        pass.buffers.push_back({lights_in_, 5, Access::read});
        pass.buffers.push_back({corners_in_, 6, Access::read});
        pass.buffers.push_back({textures_in_, 8, Access::read});
        pass.buffers.push_back({tangents_in_, 10, Access::read});
        // It also reads what its run for the sample before has left there, which is not of this frame.
        pass.buffers.push_back({graph_.create_buffer("sums", {pixels * sizeof(vec4)}), 7, Access::write});
        const std::size_t sums = pass.buffers.size() - 1;
        const graph::Written written = add_with_loops(graph_, std::move(pass));
        sums_ = written.buffers[sums];
        unfinished_ = written.buffers.back();
        graph_.keep(sums_);
        return std::move(graph_);
    }

    Passes& passes_;
    const scene::SceneRenderer& renderer_;
    GpuScene scene_;
    SampleSettings settings_;
    GpuMaterials materials_;
    std::vector<GpuCorners> corners_;
    std::vector<vec4> tangents_;
    graph::FrameGraph graph_;  // until the executor has it
    RayBuffers rays_;
    graph::BufferHandle materials_in_, textures_in_, tangents_in_, lights_in_, corners_in_, sums_,
        unfinished_;
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
