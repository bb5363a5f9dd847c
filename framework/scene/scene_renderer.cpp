#include "framework/scene/scene_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "framework/base/parallel.h"
#include "framework/image/role.h"
#include "framework/scene/capture_images.h"
#include "framework/scene/samples.h"

namespace aftershade::scene {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

SceneRenderer::SceneRenderer(const Scene& scene, int width_px, int height_px, int threads)
    : scene_(scene),
      geometry_(scene),
      width_px_(width_px),
      height_px_(height_px),
      threads_(std::max(threads, 1)) {}

double SceneRenderer::pixels_per_tangent(const CameraState& camera) const {
    return camera.focal_length_mm * width_px_ / scene_.camera.sensor_width_mm;
}

/// `pixel` is a position: the middle of the first pixel is (0.5, 0.5). `lens_m` is on the aperture as the
/// picture shows it (+y down). A point in the plane of focus stays where it is, whatever the place on the
/// lens (Cook, Porter and Carpenter 1984); t is the depth along the view axis.
Ray SceneRenderer::camera_ray(const CameraState& camera, const dvec2& pixel, const dvec2& lens_m) const {
    const dvec2 middle = 0.5 * dvec2(width_px_, height_px_);
    const dvec2 tangent = (pixel - middle) / pixels_per_tangent(camera);
    const dvec3 origin(lens_m.x, -lens_m.y, 0);
    const dvec3 direction = dvec3(tangent.x, -tangent.y, -1) - origin / camera.focus_distance_m;
    return {dvec3(camera.world_from_camera * dvec4(origin, 1)), dmat3(camera.world_from_camera) * direction};
}

bool SceneRenderer::project(const CameraState& camera, const dvec4& point, dvec2& pixel) const {
    const dvec4 view = camera.camera_from_world * point;
    if (view.z >= 0) return false;
    pixel =
        0.5 * dvec2(width_px_, height_px_) + pixels_per_tangent(camera) * dvec2(view.x, -view.y) / -view.z;
    return true;
}

/// A surface of one layer; of the last, with what shines through it.
void SceneRenderer::write_hit(Capture& capture, int x, int y, const World& world, const Surface& surface,
                              const Ray& ray, bool is_last) const {
    const Shading shading = world.shade(surface, ray.origin);
    write_surface(capture, x, y, scene_, surface, shading);
    const double opacity = world.opacity_of(surface, ray.origin);
    if (opacity >= 1) return;
    dvec3 color = opacity * shading.color();
    if (is_last) color += (1 - opacity) * world.radiance(World::past(surface, ray));
    write_color(capture, x, y, color, is_last ? 1 : opacity);
}

/// `states` are now, a frame before, a frame after. What nothing hides moves with the camera alone; a point
/// that one of two cameras has behind it gets 0.
SceneRenderer::Motion SceneRenderer::motion_of(const std::array<const SceneState*, 3>& states,
                                               const Surface* surface, const dvec3& direction) const {
    std::array<dvec2, 3> at{};
    std::array<bool, 3> valid{};
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec4 point =
            surface ? states[i]->world_from_object[std::size_t(surface->object)] * dvec4(surface->local, 1)
                    : dvec4(direction, 0);
        valid[i] = project(states[i]->camera, point, at[i]);
    }
    Motion motion;
    if (valid[0] && valid[1]) motion.velocity_px = at[0] - at[1];
    if (valid[0] && valid[2]) motion.velocity_next_px = at[2] - at[0];
    return motion;
}

Capture SceneRenderer::render_capture(int frame, double time, std::array<double, 2> jitter_px) const {
    return std::move(render_layers(frame, time, jitter_px, 1).front());
}

std::vector<Capture> SceneRenderer::render_layers(int frame, double time, std::array<double, 2> jitter_px,
                                                  int layers) const {
    const World world = world_at(frame, time);
    const SceneState before = state_at(scene_, frame, time - 1), after = state_at(scene_, frame, time + 1);
    const std::array<const SceneState*, 3> states = {&world.state(), &before, &after};
    std::vector<Capture> captures(std::size_t(layers),
                                  make_capture(frame, width_px_, height_px_, all_roles()));
    for (Capture& capture : captures)
        capture.header.camera = capture_camera(scene_, world.state(), width_px_, height_px_);
    const CameraState& camera = world.state().camera;
    for_each_row(height_px_, threads_, [&](int y) {
        for (int x = 0; x < width_px_; ++x) {
            const dvec2 pixel(x + 0.5 + jitter_px[0], y + 0.5 + jitter_px[1]);
            const Ray ray = camera_ray(camera, pixel, dvec2(0));
            const std::vector<Surface> surfaces = world.trace_through(ray, captures.size());
            for (std::size_t k = 0; k < captures.size(); ++k) {
                Capture& capture = captures[k];
                const Surface* surface = k < surfaces.size() ? &surfaces[k] : nullptr;
                capture.images.at("depth").at(x, y, 0) = float(surface ? surface->t : kFar);
                if (k > surfaces.size()) continue;
                const Motion motion = motion_of(states, surface, ray.direction);
                write_motion(capture, x, y, motion.velocity_px, motion.velocity_next_px);
                if (!surface) write_background(capture, x, y, scene_.background);
                else write_hit(capture, x, y, world, *surface, ray, k + 1 == captures.size());
            }
        }
    });
    return captures;
}

SceneRenderer::SamplePoint SceneRenderer::sample_point(const TruthSettings& truth, int index,
                                                       std::uint32_t seed) const {
    const auto count = std::uint32_t(truth.samples);
    // Each dimension in an order of its own, so that early times do not go with one side of the lens.
    const auto sample = [&](std::uint32_t dimension) {
        const std::uint32_t own_seed = pcg3d(seed, dimension, 0)[0];
        return multi_jittered(permuted(std::uint32_t(index), count, own_seed), count, own_seed + 1);
    };
    SamplePoint point;
    point.offset_px = {0.5 + truth.jitter_px[0], 0.5 + truth.jitter_px[1]};
    if (truth.kinds.antialias) point.offset_px += sample(1) - 0.5;
    if (truth.kinds.lens)
        point.on_lens =
            on_aperture(sample(2), scene_.camera.blades, glm::radians(scene_.camera.rotation_deg));
    return point;
}

World SceneRenderer::world_at(int frame, double time, double samples_of_px) const {
    SceneState state = state_at(scene_, frame, time);
    const double px_per_tangent = pixels_per_tangent(state.camera) * std::sqrt(samples_of_px);
    return World(geometry_, std::move(state), px_per_tangent);
}

/// The moments of one sample: its own for accumulation, several to choose from where pixels have their own.
std::vector<World> SceneRenderer::moments_of(int frame, const TruthSettings& truth, int sample) const {
    const bool own = truth.method == TruthMethod::interleaved && truth.kinds.shutter;
    const int count = own ? kMomentsOfSample : 1;
    const Exposure exposure = exposure_of(scene_.camera, frame);
    std::vector<World> moments;
    for (int i = 0; i < count; ++i) {
        const double time =
            truth.kinds.shutter ? exposure.middle(sample * count + i, truth.samples * count) : frame;
        moments.push_back(world_at(frame, time, truth.kinds.antialias ? truth.samples : 1));
    }
    return moments;
}

Ray SceneRenderer::sample_ray(const CameraState& camera, int x, int y, const SamplePoint& point) const {
    return camera_ray(camera, dvec2(x, y) + point.offset_px, camera.aperture_radius_m * point.on_lens);
}

SceneRenderer::PixelSample SceneRenderer::sample_of(int frame, const TruthSettings& truth, int sample, int x,
                                                    int y, const std::vector<World>& moments) const {
    std::uint32_t seed = pcg3d(truth.seed, std::uint32_t(frame), 0)[0];
    std::size_t moment = 0;
    if (truth.method == TruthMethod::interleaved) {
        seed = pcg3d(std::uint32_t(x), std::uint32_t(y), seed)[0];
        moment = pcg3d(seed, std::uint32_t(sample), 0x27d4eb2fu)[0] % moments.size();
    }
    const CameraState& camera = moments[moment].state().camera;
    return {moment, sample_ray(camera, x, y, sample_point(truth, sample, seed))};
}

void SceneRenderer::for_each_sample(int frame, const TruthSettings& truth, const SampleVisitor& visit) const {
    const std::uint32_t frame_seed = pcg3d(truth.seed, std::uint32_t(frame), 0)[0];
    for (int sample = 0; sample < truth.samples; ++sample) {
        const std::vector<World> moments = moments_of(frame, truth, sample);
        const CameraState& camera = moments.front().state().camera;
        const SamplePoint shared = sample_point(truth, sample, frame_seed);
        for_each_row(height_px_, threads_, [&](int y) {
            for (int x = 0; x < width_px_; ++x) {
                if (truth.method == TruthMethod::accumulation) {
                    visit(x, y, sample, moments.front(), sample_ray(camera, x, y, shared));
                    continue;
                }
                const PixelSample own = sample_of(frame, truth, sample, x, y, moments);
                visit(x, y, sample, moments[own.moment], own.ray);
            }
        });
    }
}

Image SceneRenderer::render_truth(int frame, const TruthSettings& truth) const {
    std::vector<dvec3> sums(std::size_t(width_px_) * std::size_t(height_px_), dvec3(0));
    for_each_sample(frame, truth, [&](int x, int y, int, const World& world, const Ray& ray) {
        sums[std::size_t(y) * std::size_t(width_px_) + std::size_t(x)] += world.radiance(ray);
    });
    Image image(width_px_, height_px_, 4);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            image.floats()[i * 4 + c] = float(sums[i][int(c)] / truth.samples);
        image.floats()[i * 4 + 3] = 1;
    }
    return image;
}

}  // namespace aftershade::scene
