#include "framework/scene/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aftershade::scene {

namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kNone = std::numeric_limits<double>::infinity();

struct Span {
    double enter = -kNone;
    double leave = kNone;
};

double first_inside(const Span& span, double low, double high) {
    if (span.enter > span.leave) return kNone;
    if (span.enter > low && span.enter < high) return span.enter;
    return span.leave > low && span.leave < high ? span.leave : kNone;
}

/// Haines et al. 2019, Precision Improvements for Ray/Sphere Intersection.
double ray_sphere(const Ray& ray, double radius, double low, double high) {
    const double a = glm::dot(ray.direction, ray.direction);
    const double b = -glm::dot(ray.origin, ray.direction);
    const dvec3 nearest = ray.origin + ray.direction * (b / a);
    const double discriminant = radius * radius - glm::dot(nearest, nearest);
    if (discriminant < 0) return kNone;
    const double q = b + std::copysign(std::sqrt(a * discriminant), b);
    const double c = glm::dot(ray.origin, ray.origin) - radius * radius;
    const double t0 = q == 0 ? 0 : c / q, t1 = q / a;
    return first_inside({std::min(t0, t1), std::max(t0, t1)}, low, high);
}

/// Kay and Kajiya 1986. A ray along a slab's face is inside it.
Span ray_slabs(const Ray& ray, const dvec3& inverse_direction, const dvec3& low, const dvec3& high) {
    Span span;
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0) {
            if (ray.origin[axis] < low[axis] || ray.origin[axis] > high[axis]) return {kNone, -kNone};
            continue;
        }
        const double a = (low[axis] - ray.origin[axis]) * inverse_direction[axis];
        const double b = (high[axis] - ray.origin[axis]) * inverse_direction[axis];
        span.enter = std::max(span.enter, std::min(a, b));
        span.leave = std::min(span.leave, std::max(a, b));
    }
    return span;
}

double ray_flat(const Ray& ray, const dvec3& half_size, bool is_disk, double low, double high) {
    const double t = -ray.origin.z / ray.direction.z;
    if (!(t > low && t < high)) return kNone;
    const dvec2 p = dvec2(ray.origin) + t * dvec2(ray.direction);
    const bool inside = is_disk ? glm::dot(p, p) <= half_size.x * half_size.x
                                : std::abs(p.x) <= half_size.x && std::abs(p.y) <= half_size.y;
    return inside ? t : kNone;
}

/// Along y: an endless cylinder cut by the slab of its caps.
double ray_cylinder(const Ray& ray, const dvec3& half_size, double low, double high) {
    const dvec2 origin(ray.origin.x, ray.origin.z), direction(ray.direction.x, ray.direction.z);
    const double a = glm::dot(direction, direction), b = glm::dot(origin, direction);
    const double c = glm::dot(origin, origin) - half_size.x * half_size.x;
    Span span;
    if (a > 0) {
        const double discriminant = b * b - a * c;
        if (discriminant < 0) return kNone;
        const double root = std::sqrt(discriminant);
        span = {(-b - root) / a, (-b + root) / a};
    } else if (c > 0) {
        return kNone;
    }
    const Ray upright{{0, ray.origin.y, 0}, {0, ray.direction.y, 0}};
    const Span caps = ray_slabs(upright, 1.0 / upright.direction, -half_size, half_size);
    return first_inside({std::max(span.enter, caps.enter), std::min(span.leave, caps.leave)}, low, high);
}

/// Moller and Trumbore 1997; both sides.
double ray_triangle(const Ray& ray, const Sides& sides, double low, double high, dvec2& barycentric) {
    const dvec3 &a = sides.corner, &ab = sides.to_second, &ac = sides.to_third;
    const dvec3 p = glm::cross(ray.direction, ac);
    const double inverse = 1 / glm::dot(ab, p);
    const dvec3 s = ray.origin - a;
    const double u = glm::dot(s, p) * inverse;
    if (!(u >= 0 && u <= 1)) return kNone;
    const dvec3 q = glm::cross(s, ab);
    const double v = glm::dot(ray.direction, q) * inverse;
    if (!(v >= 0 && u + v <= 1)) return kNone;
    const double t = glm::dot(ac, q) * inverse;
    if (!(t > low && t < high)) return kNone;
    barycentric = {u, v};
    return t;
}

bool intersect_mesh(const MeshTree& tree, const Ray& ray, double low, double high, bool any, ShapeHit& hit,
                    const Holes* holes) {
    const dvec3 inverse = 1.0 / ray.direction;
    hit.t = high;
    bool found = false;
    for (std::uint32_t at = 0; at < tree.bvh.nodes.size();) {
        const BvhNode& node = tree.bvh.nodes[at];
        if (!meets(ray, inverse, node.bounds, low, hit.t)) {
            at = node.skip;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            dvec2 barycentric;
            const double t = ray_triangle(ray, tree.sides[i], low, hit.t, barycentric);
            if (t == kNone) continue;
            const ShapeHit met{t, tree.bvh.items[i], barycentric};
            if (holes && holes->has(met)) continue;
            hit = met;
            found = true;
            if (any) return true;
        }
        ++at;
    }
    return found;
}

double around(const dvec3& p) {
    const double turns = std::atan2(p.z, p.x) / (2 * std::numbers::pi);
    return turns < 0 ? turns + 1 : turns;
}

int largest_axis(const dvec3& v) {
    return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2;
}

dvec2 box_uv(const dvec3& p, int axis) {
    const bool positive = p[axis] > 0;
    const dvec2 face = axis == 0   ? dvec2(positive ? 0.5 - p.z : 0.5 + p.z, 0.5 - p.y)
                       : axis == 1 ? dvec2(0.5 + p.x, positive ? 0.5 + p.z : 0.5 - p.z)
                                   : dvec2(positive ? 0.5 + p.x : 0.5 - p.x, 0.5 - p.y);
    const int cell = 2 * axis + (positive ? 0 : 1);
    return (dvec2(cell % 3, cell / 3) + glm::clamp(face, 0.0, 1.0)) / dvec2(3, 2);
}

ShapePoint sphere_point(const dvec3& near, double radius) {
    const dvec3 normal = glm::normalize(near);
    return {normal * radius,
            normal,
            normal,
            {around(normal), std::acos(std::clamp(normal.y, -1.0, 1.0)) / std::numbers::pi}};
}

ShapePoint box_point(const dvec3& near, const dvec3& half_size) {
    const dvec3 p = 0.5 * near / half_size;
    const int axis = largest_axis(glm::abs(p));
    ShapePoint point;
    point.normal = dvec3(0);
    point.normal[axis] = p[axis] > 0 ? 1 : -1;
    point.geometric_normal = point.normal;
    point.position = near;
    point.position[axis] = point.normal[axis] * half_size[axis];
    point.uv = box_uv(p, axis);
    return point;
}

ShapePoint cylinder_point(const dvec3& near, const dvec3& half_size) {
    ShapePoint point;
    point.position = near;
    const double out = std::hypot(near.x, near.z);
    if (half_size.y - std::abs(near.y) < half_size.x - out) {
        const double side = near.y > 0 ? 1 : -1;
        point.normal = {0, side, 0};
        // Each cap as who looks at it from outside sees it.
        const dvec2 disk = dvec2(0.5) + 0.5 * dvec2(near.x, side * near.z) / half_size.x;
        point.uv = dvec2(side > 0 ? 0 : 0.5, 2.0 / 3) + glm::clamp(disk, 0.0, 1.0) * dvec2(0.5, 1.0 / 3);
    } else {
        point.normal = dvec3(near.x, 0, near.z) / out;
        point.uv = {around(near), (0.5 - 0.5 * near.y / half_size.y) * (2.0 / 3)};
    }
    point.geometric_normal = point.normal;
    return point;
}

}  // namespace

ShapePoint mesh_point(const Mesh& mesh, const ShapeHit& hit) {
    const auto& corner = mesh.triangles[hit.triangle];
    const Vertex &a = mesh.vertices[corner[0]], &b = mesh.vertices[corner[1]], &c = mesh.vertices[corner[2]];
    const double wb = hit.barycentric.x, wc = hit.barycentric.y, wa = 1 - wb - wc;
    return {wa * a.position + wb * b.position + wc * c.position,
            wa * a.normal + wb * b.normal + wc * c.normal,
            glm::cross(b.position - a.position, c.position - a.position), wa * a.uv + wb * b.uv + wc * c.uv};
}

MeshTree::MeshTree(const Mesh& of) : mesh(&of) {
    std::vector<Bounds> bounds(of.triangles.size());
    for (std::size_t i = 0; i < bounds.size(); ++i)
        for (const std::uint32_t corner : of.triangles[i]) bounds[i].add(of.vertices[corner].position);
    bvh = build_bvh(bounds, 4);
    sides.reserve(bvh.items.size());
    for (const std::uint32_t item : bvh.items) {
        const auto& corner = of.triangles[item];
        const dvec3& a = of.vertices[corner[0]].position;
        sides.push_back({a, of.vertices[corner[1]].position - a, of.vertices[corner[2]].position - a});
    }
}

bool intersect(const Shape& shape, const MeshTree* mesh, const Ray& ray, double low, double high, bool any,
               ShapeHit& hit, const Holes* holes) {
    const dvec3& half = shape.half_size_m;
    switch (shape.kind) {
        case ShapeKind::group: return false;
        case ShapeKind::plane: hit.t = ray_flat(ray, half, false, low, high); break;
        case ShapeKind::disk: hit.t = ray_flat(ray, half, true, low, high); break;
        case ShapeKind::sphere: hit.t = ray_sphere(ray, half.x, low, high); break;
        case ShapeKind::box:
            hit.t = first_inside(ray_slabs(ray, 1.0 / ray.direction, -half, half), low, high);
            break;
        case ShapeKind::cylinder: hit.t = ray_cylinder(ray, half, low, high); break;
        case ShapeKind::mesh: return intersect_mesh(*mesh, ray, low, high, any, hit, holes);
    }
    return hit.t != kNone;
}

ShapePoint point_of(const Shape& shape, const MeshTree* mesh, const Ray& ray, const ShapeHit& hit) {
    const dvec3& half = shape.half_size_m;
    const dvec3 near = ray.origin + hit.t * ray.direction;
    switch (shape.kind) {
        case ShapeKind::sphere: return sphere_point(near, half.x);
        case ShapeKind::box: return box_point(near, half);
        case ShapeKind::cylinder: return cylinder_point(near, half);
        case ShapeKind::mesh: return mesh_point(*mesh->mesh, hit);
        default: break;
    }
    const dvec3 up(0, 0, 1);
    return {{near.x, near.y, 0}, up, up, {0.5 + 0.5 * near.x / half.x, 0.5 - 0.5 * near.y / half.y}};
}

Bounds bounds_of(const Shape& shape, const MeshTree* mesh) {
    Bounds bounds;
    if (shape.kind == ShapeKind::group) return bounds;
    if (shape.kind == ShapeKind::mesh) return mesh->bvh.nodes.empty() ? bounds : mesh->bvh.nodes[0].bounds;
    dvec3 half = shape.half_size_m;
    if (shape.kind == ShapeKind::plane || shape.kind == ShapeKind::disk) half.z = 0;
    bounds.add(half);
    bounds.add(-half);
    return bounds;
}

}  // namespace aftershade::scene
