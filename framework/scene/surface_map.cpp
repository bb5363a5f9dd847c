#include "framework/scene/surface_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

namespace aftershade::scene {

namespace {

struct SurfacePoint {
    glm::dvec3 position;
    glm::dvec3 normal;
};

void put(SurfaceMap& map, int x, int y, const SurfacePoint& point) {
    for (int c = 0; c < 3; ++c) {
        map.position.at(x, y, c) = float(point.position[c]);
        map.normal.at(x, y, c) = float(point.normal[c]);
    }
    map.position.at(x, y, 3) = 1;
    map.normal.at(x, y, 3) = 1;
}

/// From -1 to 1 over a cell.
double sided(double part) {
    return 2 * part - 1;
}

SurfacePoint plane_at(double u, double v, const glm::dvec3& h) {
    return {{sided(u) * h.x, -sided(v) * h.y, 0}, {0, 0, 1}};
}

std::optional<SurfacePoint> disk_at(double u, double v, double radius) {
    if (std::hypot(sided(u), sided(v)) > 1) return std::nullopt;
    return plane_at(u, v, {radius, radius, 0});
}

SurfacePoint sphere_at(double u, double v, double radius) {
    const double longitude = 2 * std::numbers::pi * u;
    const double from_pole = std::numbers::pi * v;
    const glm::dvec3 normal(std::sin(from_pole) * std::cos(longitude), std::cos(from_pole),
                            std::sin(from_pole) * std::sin(longitude));
    return {radius * normal, normal};
}

SurfacePoint box_at(double u, double v, const glm::dvec3& h) {
    // Of each face: outwards, to the right and down, as seen from outside.
    struct Face {
        glm::dvec3 out, right, down;
    };
    static const Face kFaces[2][3] = {{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                       {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                       {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}},
                                      {{{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                       {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                                       {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}}};
    const int column = std::min(int(3 * u), 2);
    const int row = std::min(int(2 * v), 1);
    const Face& face = kFaces[row][column];
    return {(face.out + sided(3 * u - column) * face.right + sided(2 * v - row) * face.down) * h, face.out};
}

std::optional<SurfacePoint> cylinder_at(double u, double v, const glm::dvec3& h) {
    if (3 * v < 2) {
        const double around = 2 * std::numbers::pi * u;
        const glm::dvec3 normal(std::cos(around), 0, std::sin(around));
        return SurfacePoint{{h.x * normal.x, -sided(1.5 * v) * h.y, h.x * normal.z}, normal};
    }
    const int column = std::min(int(2 * u), 1);
    const double up = column == 0 ? 1 : -1;
    const double right = sided(2 * u - column);
    const double down = sided(3 * v - 2);
    if (std::hypot(right, down) > 1) return std::nullopt;
    return SurfacePoint{{right * h.x, up * h.y, up * down * h.x}, {0, up, 0}};
}

std::optional<SurfacePoint> point_at(const Shape& shape, double u, double v) {
    switch (shape.kind) {
        case ShapeKind::plane: return plane_at(u, v, shape.half_size_m);
        case ShapeKind::disk: return disk_at(u, v, shape.half_size_m.x);
        case ShapeKind::sphere: return sphere_at(u, v, shape.half_size_m.x);
        case ShapeKind::box: return box_at(u, v, shape.half_size_m);
        case ShapeKind::cylinder: return cylinder_at(u, v, shape.half_size_m);
        case ShapeKind::group:
        case ShapeKind::mesh: break;
    }
    return std::nullopt;
}

/// Twice the signed area of a, b, c.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The same on the left of the line from a to b; exactly opposite for b to a, so that no texel is lost
/// between two triangles.
double edge_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point) {
    const bool ordered = a.x < b.x || (a.x == b.x && a.y < b.y);
    return ordered ? area(a, b, point) : -area(b, a, point);
}

/// The texels whose centres can lie between `low` and `high`; none where last < first.
struct TexelRange {
    TexelRange(double low, double high, int side_px)
        : first(int(std::floor(std::clamp(low, 0.0, 1.0) * side_px - 0.5))),
          last(int(std::ceil(std::clamp(high, 0.0, 1.0) * side_px - 0.5))) {
        first = std::max(first, 0);
        last = std::min(last, side_px - 1);
    }
    int first;
    int last;
};

SurfacePoint interpolate(const Vertex& a, const Vertex& b, const Vertex& c, const glm::dvec3& weights) {
    const glm::dvec3 position = weights.x * a.position + weights.y * b.position + weights.z * c.position;
    const glm::dvec3 normal = weights.x * a.normal + weights.y * b.normal + weights.z * c.normal;
    const double length = glm::length(normal);
    // Opposite normals can cancel between the corners.
    return {position, length > 0 ? normal / length : a.normal};
}

void draw_triangle(SurfaceMap& map, const Mesh& mesh, std::uint32_t index) {
    const auto& corner = mesh.triangles[index];
    const Vertex &a = mesh.vertices[corner[0]], &b = mesh.vertices[corner[1]], &c = mesh.vertices[corner[2]];
    const double whole = area(a.uv, b.uv, c.uv);
    if (!(std::abs(whole) > 0) || !std::isfinite(whole)) return;
    const int side_px = map.position.width();
    const TexelRange rows(std::min({a.uv.y, b.uv.y, c.uv.y}), std::max({a.uv.y, b.uv.y, c.uv.y}), side_px);
    const TexelRange columns(std::min({a.uv.x, b.uv.x, c.uv.x}), std::max({a.uv.x, b.uv.x, c.uv.x}), side_px);
    for (int y = rows.first; y <= rows.last; ++y)
        for (int x = columns.first; x <= columns.last; ++x) {
            if (map.position.at(x, y, 3) != 0) continue;
            const glm::dvec2 uv = (glm::dvec2(x, y) + 0.5) / double(side_px);
            const glm::dvec3 weights =
                glm::dvec3(edge_area(b.uv, c.uv, uv), edge_area(c.uv, a.uv, uv), edge_area(a.uv, b.uv, uv)) /
                whole;
            if (weights.x < 0 || weights.y < 0 || weights.z < 0) continue;
            put(map, x, y, interpolate(a, b, c, weights));
            map.triangle.uint_at(x, y, 0) = index;
            map.weights.at(x, y, 0) = float(weights.y);
            map.weights.at(x, y, 1) = float(weights.z);
        }
}

}  // namespace

SurfaceMap make_surface_map(const Shape& shape, const Mesh* mesh, int side_px) {
    assert(side_px >= 1 && (shape.kind == ShapeKind::mesh) == (mesh != nullptr));
    SurfaceMap map{Image(side_px, side_px, 4), Image(side_px, side_px, 4), {}, {}};
    if (mesh) {
        map.triangle = Image(side_px, side_px, 1, ComponentType::uint32);
        map.weights = Image(side_px, side_px, 2);
        for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) draw_triangle(map, *mesh, i);
        return map;
    }
    for (int y = 0; y < side_px; ++y)
        for (int x = 0; x < side_px; ++x)
            if (const auto point = point_at(shape, (x + 0.5) / side_px, (y + 0.5) / side_px))
                put(map, x, y, *point);
    return map;
}

}  // namespace aftershade::scene
