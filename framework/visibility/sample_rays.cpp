#include "framework/visibility/sample_rays.h"

#include <array>
#include <bit>

#include "framework/base/parallel.h"
#include "framework/visibility/gpu_scene.h"

namespace aftershade::visibility {

using glm::vec4;

namespace {

/// Where the sample stops at transparent surfaces.
void set_stops(GpuRay& ray, std::uint32_t seed, int sample, const scene::VisibilitySettings& settings) {
    const scene::StopNumbers stops(seed, sample, settings.samples);
    const std::array<double, 4>& first = stops.first();
    ray.stops = vec4(first[0], first[1], first[2], first[3]);
}

}  // namespace

SampleSettings sample_settings(const scene::SceneRenderer& renderer, const scene::CameraState& reference,
                               int samples) {
    const scene::Scene& of = renderer.scene();
    SampleSettings settings;
    settings.size_px = {renderer.width_px(), renderer.height_px()};
    settings.px_per_tangent = float(renderer.pixels_per_tangent(reference));
    settings.sample_count = std::uint32_t(samples);
    settings.transparent = of.has_transparency() ? 1 : 0;
    settings.light_count = std::uint32_t(of.lights.size());
    settings.ambient = with(of.ambient, double(of.ambient_rays));
    settings.background = with(of.background);
    settings.camera_right = with(glm::dvec3(reference.world_from_camera[0]));
    settings.camera_up = with(glm::dvec3(reference.world_from_camera[1]));
    return settings;
}

std::vector<GpuRay> rays_of_band(const scene::SceneRenderer& renderer, int frame,
                                 const scene::VisibilitySettings& settings, int sample,
                                 const std::vector<scene::World>& moments, int first_row, int rows) {
    const scene::TruthSettings truth = truth_of(settings);
    const bool transparent = renderer.scene().has_transparency();
    std::vector<GpuRay> rays(std::size_t(renderer.width_px()) * std::size_t(rows));
    for_each_row(rows, renderer.threads(), [&](int row) {
        for (int x = 0; x < renderer.width_px(); ++x) {
            const auto own = renderer.sample_of(frame, truth, sample, x, first_row + row, moments);
            GpuRay& ray = rays[std::size_t(row) * std::size_t(renderer.width_px()) + std::size_t(x)];
            ray.origin = vec4(glm::vec3(own.ray.origin), std::bit_cast<float>(std::uint32_t(own.moment)));
            const std::uint32_t seed =
                scene::StopNumbers::pixel_seed(settings.seed, frame, x, first_row + row);
            ray.direction = vec4(glm::vec3(own.ray.direction), std::bit_cast<float>(seed));
            if (transparent) set_stops(ray, seed, sample, settings);
        }
    });
    return rays;
}

}  // namespace aftershade::visibility
