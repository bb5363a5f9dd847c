#include "framework/scene/world.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace aftershade::scene {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

namespace {

dvec3 point(const dmat4& matrix, const dvec3& p) {
    return dvec3(matrix * dvec4(p, 1));
}

/// Both normals on the side that the ray came from.
void face(Surface& surface, bool from_behind) {
    surface.from_behind = from_behind;
    if (from_behind) surface.geometric_normal = -surface.geometric_normal;
    if (glm::dot(surface.geometric_normal, surface.normal) < 0) surface.normal = -surface.normal;
}

}  // namespace

Geometry::Geometry(const Scene& scene) : scene_(scene) {
    meshes_.reserve(scene.meshes.size());
    for (const Mesh& mesh : scene.meshes) meshes_.emplace_back(mesh);
    std::map<int, ObjectAlpha> of_mesh;  // with materials of its own, which all of its objects have
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const bool own = scene.objects[i].has_mesh_materials;
        const auto known = own ? of_mesh.find(scene.objects[i].shape.mesh) : of_mesh.end();
        if (known != of_mesh.end()) {
            alphas_.push_back(known->second);
            continue;
        }
        ObjectAlpha& alpha = alphas_.emplace_back();
        for (const std::size_t material : scene.materials_of(int(i))) {
            alpha.has_holes = alpha.has_holes || scene.materials[material].alpha_cutoff > 0;
            alpha.is_mixed = alpha.is_mixed || (own && scene.materials[material].is_transparent());
        }
        if (own) of_mesh[scene.objects[i].shape.mesh] = alpha;
    }
}

TexturePoint Geometry::texture_point(int object, const ShapeHit& hit) const {
    TexturePoint point;
    point.mesh = mesh_of(scene_.objects[std::size_t(object)].shape)->mesh;
    point.triangle = hit.triangle;
    point.barycentric = hit.barycentric;
    point.uv = mesh_point(*point.mesh, hit).uv;
    return point;
}

namespace {

class HolesOfObject : public Holes {
public:
    HolesOfObject(const Geometry& geometry, int object) : geometry_(geometry), object_(object) {}
    bool has(const ShapeHit& hit) const override {
        const Scene& scene = geometry_.scene();
        const Material& material = scene.materials[scene.material_at(object_, hit.triangle)];
        return material.alpha_cutoff > 0 && is_hole(material, geometry_.texture_point(object_, hit));
    }

private:
    const Geometry& geometry_;
    int object_;
};

}  // namespace

World::World(const Geometry& geometry, SceneState state, double px_per_tangent)
    : geometry_(&geometry), state_(std::move(state)), px_per_tangent_(px_per_tangent) {
    for (std::size_t i = 0; i < state_.world_from_object.size(); ++i) {
        const Object& object = scene().objects[i];
        const MeshTree* mesh = geometry.mesh_of(object.shape);
        const Bounds local = bounds_of(object.shape, mesh);
        seen_of_object_.push_back(local.empty() ? -1 : int(seen_.size()));
        if (local.empty()) continue;
        const dmat4& matrix = state_.world_from_object[i];
        seen_.push_back({int(i), object.casts_shadow, scene().material_of(int(i)).opacity,
                         geometry.alpha_of(i), &object.shape, mesh, glm::dmat4x3(glm::inverse(matrix))});
        bounds_.push_back(transformed(local, matrix));
        // A flat box keeps rays that run along it only if it has some height.
        const dvec3 margin = 1e-12 * glm::max(glm::abs(bounds_.back().low), glm::abs(bounds_.back().high));
        bounds_.back().low -= margin;
        bounds_.back().high += margin;
    }
    bvh_ = build_bvh(bounds_, 2);
}

Bounds World::bounds(int object) const {
    const int seen = seen_of_object_[std::size_t(object)];
    return seen < 0 ? Bounds() : bounds_[std::size_t(seen)];
}

dvec3 World::to_object(int object, const dvec3& position) const {
    return seen_[std::size_t(seen_of_object_[std::size_t(object)])].object_from_world * dvec4(position, 1);
}

Ray World::to_object(int object, const Ray& ray) const {
    return seen_[std::size_t(seen_of_object_[std::size_t(object)])].local(ray);
}

/// Calls visit(seen) for objects whose boxes the ray meets before `high`, which it may lower; ends where it
/// returns true.
template <class Visit>
void World::walk(const Ray& ray, double low, double& high, const Visit& visit) const {
    const dvec3 inverse = 1.0 / ray.direction;
    for (std::uint32_t at = 0; at < bvh_.nodes.size();) {
        const BvhNode& node = bvh_.nodes[at];
        if (!meets(ray, inverse, node.bounds, low, high)) {
            at = node.skip;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            if (visit(seen_[bvh_.items[i]])) return;
        ++at;
    }
}

/// intersect() with the object's holes.
bool World::meets_object(const Seen& seen, const Ray& local, double low, double high, bool any,
                         ShapeHit& hit) const {
    if (!seen.alpha.has_holes) return intersect(*seen.shape, seen.mesh, local, low, high, any, hit);
    const HolesOfObject holes(*geometry_, seen.object);
    return intersect(*seen.shape, seen.mesh, local, low, high, any, hit, &holes);
}

double World::opacity_of(const Surface& surface, const dvec3& eye) const {
    if (!geometry_->alpha_of(std::size_t(surface.object)).is_mixed)
        return scene().material_of(surface.object).opacity;
    const Material& material = material_at(surface);
    if (!material.blends) return material.opacity;
    TexturePoint at = texture_point(surface);
    at.weights_of_pixel = weights_of_pixel(surface, eye);
    return opacity_at(material, at);
}

std::optional<Surface> World::trace(const Ray& ray, double low, double high, int only) const {
    const Seen* nearest = nullptr;
    ShapeHit nearest_hit;
    const auto visit = [&](const Seen& seen) {
        ShapeHit hit;
        if (meets_object(seen, seen.local(ray), low, high, false, hit)) {
            nearest = &seen;
            nearest_hit = hit;
            high = hit.t;
        }
        return false;
    };
    if (only < 0) walk(ray, low, high, visit);
    else visit(seen_[std::size_t(seen_of_object_[std::size_t(only)])]);
    if (!nearest) return std::nullopt;
    Surface found =
        surface(nearest->object, point_of(*nearest->shape, nearest->mesh, nearest->local(ray), nearest_hit));
    found.t = nearest_hit.t;
    found.triangle = nearest_hit.triangle;
    found.barycentric = nearest_hit.barycentric;
    face(found, glm::dot(found.geometric_normal, ray.direction) > 0);
    return found;
}

std::vector<Surface> World::trace_through(const Ray& ray, std::size_t most) const {
    std::vector<Surface> found;
    std::vector<int> entered;  // opaque objects, once for each front that has no back yet
    cross(ray, [&](const Surface& surface) {
        const auto inside = std::find(entered.begin(), entered.end(), surface.object);
        if (surface.from_behind && inside != entered.end()) {
            entered.erase(inside);
            return true;
        }
        if (!surface.from_behind && opacity_of(surface, ray.origin) >= 1) entered.push_back(surface.object);
        found.push_back(surface);
        return found.size() < most;
    });
    return found;
}

dvec3 World::radiance(const Ray& ray, int* shadings) const {
    dvec3 light(0);
    double through = 1;
    cross(ray, [&](const Surface& surface) {
        const double opacity = opacity_of(surface, ray.origin);
        if (opacity <= 0) return true;
        light += through * opacity * shade(surface, ray.origin).color();
        through *= 1 - opacity;
        if (shadings) ++*shadings;
        return through > 0;
    });
    return through > 0 ? light + through * scene().background : light;
}

bool World::is_hidden(const dvec3& from, const dvec3& to) const {
    const Ray ray{from, to - from};
    double high = 1;
    bool hidden = false;
    walk(ray, 0, high, [&](const Seen& seen) {
        ShapeHit hit;
        hidden = meets_object(seen, seen.local(ray), 0, 1, true, hit);
        return hidden;
    });
    return hidden;
}

double World::light_through(const dvec3& from, const dvec3& to) const {
    const Ray ray{from, to - from};
    double high = 1, share = 1;
    walk(ray, 0, high, [&](const Seen& seen) {
        if (!seen.casts_shadow) return false;
        const Ray local = seen.local(ray);
        const bool opaque = seen.opacity >= 1 && !seen.alpha.is_mixed;
        ShapeHit hit;
        double low = 0;
        for (int crossing = 0; crossing < kMostCrossings && share > 0; ++crossing) {
            if (!meets_object(seen, local, low, 1, opaque, hit)) break;
            double opacity = seen.opacity;
            if (seen.alpha.is_mixed)
                opacity = opacity_at(scene().materials[scene().material_at(seen.object, hit.triangle)],
                                     geometry_->texture_point(seen.object, hit));
            share *= 1 - opacity;
            low = hit.t * kPast;
        }
        return share <= 0;
    });
    return share;
}

Surface World::surface(int object, const ShapePoint& on_shape) const {
    // Normals go by the inverse's transpose.
    const Seen& seen = seen_[std::size_t(seen_of_object_[std::size_t(object)])];
    const dmat3 normal_matrix = glm::transpose(dmat3(seen.object_from_world));
    Surface surface;
    surface.position = point(state_.world_from_object[std::size_t(object)], on_shape.position);
    surface.local = on_shape.position;
    surface.normal = glm::normalize(normal_matrix * on_shape.normal);
    surface.geometric_normal = glm::normalize(normal_matrix * on_shape.geometric_normal);
    surface.uv = on_shape.uv;
    surface.object = object;
    return surface;
}

Surface World::surface_on(int object, std::uint32_t triangle, const glm::dvec2& barycentric,
                          bool from_behind) const {
    const Seen& seen = seen_[std::size_t(seen_of_object_[std::size_t(object)])];
    Surface found = surface(object, point_of(*seen.shape, seen.mesh, {}, {0, triangle, barycentric}));
    found.triangle = triangle;
    found.barycentric = barycentric;
    face(found, from_behind);
    return found;
}

}  // namespace aftershade::scene
