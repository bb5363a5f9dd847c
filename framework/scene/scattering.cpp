#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include "framework/base/parallel.h"
#include "framework/scene/scatter_points.h"
#include "framework/scene/scene_renderer.h"

namespace aftershade::scene {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

/// A sphere stays one where its three axes keep one length and their right angles.
bool is_round(const glm::dmat4& matrix) {
    const dvec3 x(matrix[0]), y(matrix[1]), z(matrix[2]);
    const dvec3 axes(glm::length(x), glm::length(y), glm::length(z));
    const double skew =
        std::max({std::abs(glm::dot(x, y)), std::abs(glm::dot(y, z)), std::abs(glm::dot(z, x))});
    return std::max({axes.x, axes.y, axes.z}) - std::min({axes.x, axes.y, axes.z}) < 1e-9 * axes.x &&
           skew < 1e-9 * axes.x * axes.x;
}

/// The points around one pixel's own, and what they send there.
class Gather {
public:
    Gather(const World& world, const dvec3& eye, bool visible_only, const Surface& here)
        : world_(world),
          eye_(eye),
          visible_only_(visible_only),
          here_(here),
          object_(world.scene().objects[std::size_t(here.object)]),
          scattering_(*world.scene().materials[std::size_t(object_.material)].scattering) {
        const dvec3& normal = here.geometric_normal;
        const dvec3 across = std::abs(normal.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
        tangent_ = glm::normalize(glm::cross(across, normal));
        bitangent_ = glm::cross(normal, tangent_);
    }

    dvec3 scattered(const std::vector<ScatterPoint>& points) {
        const ShapeKind kind = object_.shape.kind;
        const auto& matrix = world_.state().world_from_object[std::size_t(here_.object)];
        const bool flat = kind == ShapeKind::plane || kind == ShapeKind::disk;
        const bool round = kind == ShapeKind::sphere && is_round(matrix);
        const dvec3 centre(matrix[3]);
        for (const ScatterPoint& point : points) {
            const dvec3 along = std::cos(point.angle_rad) * tangent_ + std::sin(point.angle_rad) * bitangent_;
            if (flat) add_on_plane(along, point.radius_m, point.area_m2);
            else if (round) add_on_sphere(centre, along, point.radius_m, point.area_m2);
            else add_by_probe(along, point.radius_m, point.area_m2);
        }
        dvec3 light(0);
        for (int c = 0; c < 3; ++c)
            if (weights_[c] > 0) light[c] = sum_[c] / weights_[c];
        const Rgb& direct = scattering_.profile.direct;
        if (direct == Rgb{}) return light;
        return glm::mix(light, world_.irradiance(here_), dvec3(direct[0], direct[1], direct[2]));
    }

private:
    void add(const Surface& there, double radius_m, double area_m2) {
        // From a little before the point, so that it does not hide itself.
        if (visible_only_ && world_.is_hidden(eye_, glm::mix(there.position, eye_, 1e-6))) return;
        dvec3 weight;
        for (int c = 0; c < 3; ++c) weight[c] = scattering_density(scattering_, c, radius_m) * area_m2;
        sum_ += weight * world_.irradiance(there);
        weights_ += weight;
    }

    void add_on_plane(const dvec3& along, double radius_m, double area_m2) {
        Surface there = here_;
        there.position += radius_m * along;
        const dvec3 local = world_.to_object(here_.object, there.position);
        const dvec3& half = object_.shape.half_size_m;
        const bool inside = object_.shape.kind == ShapeKind::disk
                                ? std::hypot(local.x, local.y) <= half.x
                                : std::abs(local.x) <= half.x && std::abs(local.y) <= half.y;
        if (inside) add(there, radius_m, area_m2);
    }

    /// With the chord r as radius, an area of the sphere about a point is r dr dphi, as in a plane.
    void add_on_sphere(const dvec3& centre, const dvec3& along, double chord_m, double area_m2) {
        const double radius_m = glm::distance(here_.position, centre);
        // From inside the sphere the normal points at its centre.
        const double side = glm::dot(here_.geometric_normal, here_.position - centre) < 0 ? -1 : 1;
        const double half_sine = chord_m / (2 * radius_m);
        if (half_sine > 1) return;
        const double sine = 2 * half_sine * std::sqrt(1 - half_sine * half_sine);
        Surface there = here_;
        const dvec3 out = side * here_.geometric_normal * (1 - 2 * half_sine * half_sine) + along * sine;
        there.normal = there.geometric_normal = side * out;
        there.position = centre + radius_m * out;
        add(there, chord_m, area_m2);
    }

    void add_by_probe(const dvec3& along, double radius_m, double area_m2) {
        const double reach_m = 3 * radius_m;
        const dvec3& normal = here_.geometric_normal;
        const Ray probe{here_.position + radius_m * along + reach_m * normal, -normal};
        double low = 0;
        for (int i = 0; i < kMaxCrossings; ++i) {
            auto there = world_.trace(probe, low, 2 * reach_m, here_.object);
            if (!there) return;
            low = there->t + 1e-9 * reach_m;
            // The surface's same side counts, whichever the probe meets: it may begin inside the object.
            if (there->from_behind != here_.from_behind) {
                there->normal = -there->normal;
                there->geometric_normal = -there->geometric_normal;
            }
            const double cosine = std::max(std::abs(glm::dot(there->geometric_normal, normal)), 0.1);
            add(*there, glm::distance(there->position, here_.position), area_m2 / cosine);
        }
    }

    static constexpr int kMaxCrossings = 8;

    const World& world_;
    dvec3 eye_;
    bool visible_only_;
    const Surface& here_;
    const Object& object_;
    const Scattering& scattering_;
    dvec3 tangent_, bitangent_;
    dvec3 sum_{0}, weights_{0};
};

}  // namespace

ScatteringTruth SceneRenderer::render_scattering(int frame, const ScatteringSettings& scattering) const {
    Capture capture = render_capture(frame, frame, scattering.jitter_px);
    ScatteringTruth truth{std::move(capture.images.at("irradiance")), std::move(capture.images.at("color"))};
    const Image& albedo = capture.images.at("albedo");
    const World world = world_at(frame, frame);
    std::vector<std::vector<ScatterPoint>> points;
    for (const Material& material : scene_.materials)
        points.push_back(material.scattering ? make_scatter_points(*material.scattering, scattering.samples)
                                             : std::vector<ScatterPoint>());
    const dvec2 offset_px(0.5 + scattering.jitter_px[0], 0.5 + scattering.jitter_px[1]);
    for_each_row(height_px_, threads_, [&](int y) {
        for (int x = 0; x < width_px_; ++x) {
            const Ray ray = camera_ray(world.state().camera, dvec2(x, y) + offset_px, dvec2(0));
            const auto here = world.trace(ray, 0, std::numeric_limits<double>::infinity());
            if (!here) continue;
            const auto& table = points[std::size_t(scene_.objects[std::size_t(here->object)].material)];
            if (table.empty()) continue;
            Gather gather(world, ray.origin, scattering.visible_only, *here);
            const dvec3 light = gather.scattered(table);
            for (int c = 0; c < 3; ++c) {
                truth.color.at(x, y, c) +=
                    albedo.at(x, y, c) * (float(light[c]) - truth.irradiance.at(x, y, c));
                truth.irradiance.at(x, y, c) = float(light[c]);
            }
        }
    });
    return truth;
}

}  // namespace aftershade::scene
