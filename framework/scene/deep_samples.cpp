// Deep pictures of a scene: many rays a pixel, and what they meet of one object as one sample.
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "framework/base/parallel.h"
#include "framework/scene/scene_renderer.h"

namespace aftershade::scene {

using glm::dvec2;
using glm::dvec3;

namespace {

constexpr std::size_t kMostSurfaces = 64;  ///< of one ray
/// What a sample may span, as a ratio of depths; parts of an object that lie further apart become several.
constexpr double kSpan = 1.25;

/// What one ray meets, or several of one object.
struct Hit {
    int object = -1;     ///< -1: the background
    int occurrence = 0;  ///< how often the ray has met the object before: such hits do not lie side by side
    double front_m = std::numeric_limits<double>::infinity();
    double back_m = std::numeric_limits<double>::infinity();
    dvec3 color{0};    ///< premultiplied, the sum over the rays
    double alpha = 1;  ///< the sum over the rays
    dvec3 normal{0};
    std::uint32_t id = 0;
    dvec2 velocity_px{0}, velocity_next_px{0};
};

constexpr std::array kChannels = {"R",
                                  "G",
                                  "B",
                                  "A",
                                  "Z",
                                  "ZBack",
                                  "velocity.X",
                                  "velocity.Y",
                                  "velocity_next.X",
                                  "velocity_next.Y",
                                  "normal.X",
                                  "normal.Y",
                                  "normal.Z"};

/// In the order of kChannels.
std::array<double, kChannels.size()> values_of(const Hit& hit, int rays) {
    const dvec3 color = hit.color / double(rays);
    return {color.x,
            color.y,
            color.z,
            std::min(1.0, hit.alpha / rays),
            hit.front_m,
            hit.back_m,
            hit.velocity_px.x,
            hit.velocity_px.y,
            hit.velocity_next_px.x,
            hit.velocity_next_px.y,
            hit.normal.x,
            hit.normal.y,
            hit.normal.z};
}

/// By depth, hits of one object together.
void merge(std::vector<Hit>& hits) {
    std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
        return std::tie(a.object, a.occurrence, a.front_m) < std::tie(b.object, b.occurrence, b.front_m);
    });
    std::vector<Hit> merged;
    for (const Hit& hit : hits) {
        Hit* last = merged.empty() ? nullptr : &merged.back();
        if (!last || last->object != hit.object || last->occurrence != hit.occurrence ||
            hit.front_m > last->front_m * kSpan) {
            merged.push_back(hit);
            continue;
        }
        last->back_m = hit.back_m;
        last->color += hit.color;
        last->alpha += hit.alpha;
    }
    std::stable_sort(merged.begin(), merged.end(),
                     [](const Hit& a, const Hit& b) { return a.front_m < b.front_m; });
    hits = std::move(merged);
}

}  // namespace

DeepImage SceneRenderer::render_deep(int frame, double time, std::array<double, 2> jitter_px) const {
    const World world = world_at(frame, time, kDeepRays);
    const SceneState before = state_at(scene_, frame, time - 1), after = state_at(scene_, frame, time + 1);
    const std::array<const SceneState*, 3> states = {&world.state(), &before, &after};
    const auto hits_of = [&](int x, int y) {
        constexpr int kSide = 4;
        static_assert(kSide * kSide == kDeepRays);
        std::vector<Hit> hits;
        for (int i = 0; i < kDeepRays; ++i) {
            const int column = i % kSide, row = i / kSide;
            const dvec2 pixel(x + jitter_px[0] + (column + 0.5) / kSide,
                              y + jitter_px[1] + (row + 0.5) / kSide);
            const Ray ray = camera_ray(world.state().camera, pixel, dvec2(0));
            std::map<int, int> met;
            for (const Surface& surface : world.trace_through(ray, kMostSurfaces)) {
                const Motion motion = motion_of(states, &surface, ray.direction);
                const double opacity = world.opacity_of(surface, ray.origin);
                const Shading shading = world.shade(surface, ray.origin);
                hits.push_back({surface.object, met[surface.object]++, surface.t, surface.t,
                                opacity * shading.color(), opacity, shading.normal,
                                scene_.objects[std::size_t(surface.object)].id, motion.velocity_px,
                                motion.velocity_next_px});
            }
            const Motion motion = motion_of(states, nullptr, ray.direction);
            hits.push_back({-1, 0, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::infinity(), scene_.background, 1, dvec3(0), 0,
                            motion.velocity_px, motion.velocity_next_px});
        }
        merge(hits);
        return hits;
    };
    std::vector<std::vector<std::vector<Hit>>> rows(static_cast<std::size_t>(height_px_));
    for_each_row(height_px_, threads_, [&](int y) {
        for (int x = 0; x < width_px_; ++x) rows[std::size_t(y)].push_back(hits_of(x, y));
    });
    DeepImage image;
    image.width = width_px_;
    image.height = height_px_;
    for (const char* name : kChannels) image.channels.push_back({name});
    DeepImage::Channel ids{"object_id.I"};
    image.first.push_back(0);
    for (const auto& row : rows)
        for (const std::vector<Hit>& hits : row) {
            for (const Hit& hit : hits) {
                const auto values = values_of(hit, kDeepRays);
                for (std::size_t c = 0; c < values.size(); ++c)
                    image.channels[c].floats.push_back(float(values[c]));
                ids.uints.push_back(hit.id);
            }
            image.first.push_back(image.first.back() + std::uint32_t(hits.size()));
        }
    image.channels.push_back(std::move(ids));
    return image;
}

}  // namespace aftershade::scene
