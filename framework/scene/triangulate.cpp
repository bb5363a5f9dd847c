#include "framework/scene/triangulate.h"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <tuple>

#include "framework/scene/shape.h"

namespace aftershade::scene {

using glm::dvec2;
using glm::dvec3;

namespace {

/// Beside an edge, where two faces of a shape meet, on the one that is meant.
constexpr double kInside = 1 - 1e-9;

/// The shape's normal and texture coordinates at `near`, for a corner that lies at `exact`.
Vertex corner_of(const Shape& shape, const dvec3& near, const dvec3& exact) {
    const ShapePoint point = point_of(shape, nullptr, {near, dvec3(0)}, {});
    return {exact, glm::normalize(point.normal), point.uv};
}

/// A grid of corners; columns times rows points outwards. Triangles without an area, at poles, are left out.
void add_patch(Mesh& mesh, int columns, int rows, const std::function<Vertex(int column, int row)>& corner) {
    const auto first = std::uint32_t(mesh.vertices.size()), side = std::uint32_t(columns) + 1;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) mesh.vertices.push_back(corner(column, row));
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto at = [&](std::uint32_t i) { return mesh.vertices[i].position; };
        if (at(a) != at(b) && at(b) != at(c) && at(c) != at(a)) mesh.triangles.push_back({a, b, c});
    };
    for (std::uint32_t row = 0; row < std::uint32_t(rows); ++row)
        for (std::uint32_t column = 0; column < std::uint32_t(columns); ++column) {
            const std::uint32_t at = first + row * side + column;
            add(at, at + 1, at + side);
            add(at + 1, at + side + 1, at + side);
        }
}

/// (cos, sin) of a part of a turn; exactly the first one again at the end.
dvec2 turn(int part, int parts) {
    const double angle_rad = 2 * std::numbers::pi * (part % parts) / parts;
    return {std::cos(angle_rad), std::sin(angle_rad)};
}

void add_plane(Mesh& mesh, const Shape& shape) {
    add_patch(mesh, 1, 1, [&](int column, int row) {
        const dvec3 at = dvec3(2 * column - 1, 2 * row - 1, 0) * dvec3(dvec2(shape.half_size_m), 0);
        return corner_of(shape, at, at);
    });
}

void add_disk(Mesh& mesh, const Shape& shape) {
    add_patch(mesh, kTrianglesAround, 1, [&](int column, int row) {
        const dvec3 at(turn(column, kTrianglesAround) * (row == 0 ? shape.half_size_m.x : 0.0), 0);
        return corner_of(shape, at, at);
    });
}

void add_sphere(Mesh& mesh, const Shape& shape) {
    constexpr int kDown = kTrianglesAround / 2;
    add_patch(mesh, kTrianglesAround, kDown, [&](int column, int row) {
        const double angle_rad = std::numbers::pi * row / kDown;
        const dvec2 out = turn(column, kTrianglesAround) * (row % kDown == 0 ? 0 : std::sin(angle_rad));
        const dvec3 at = shape.half_size_m.x * dvec3(out.x, std::cos(angle_rad), out.y);
        Vertex corner = corner_of(shape, at, at);
        corner.uv = dvec2(double(column) / kTrianglesAround, double(row) / kDown);
        return corner;
    });
}

void add_box(Mesh& mesh, const Shape& shape) {
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1})
            add_patch(mesh, 1, 1, [&](int column, int row) {
                dvec3 unit(0);
                unit[axis] = side;
                unit[(axis + 1) % 3] = (side > 0 ? 1 : -1) * (2 * column - 1);
                unit[(axis + 2) % 3] = 2 * row - 1;
                dvec3 near = kInside * unit;
                near[axis] = unit[axis];
                return corner_of(shape, near * shape.half_size_m, unit * shape.half_size_m);
            });
}

void add_cylinder(Mesh& mesh, const Shape& shape) {
    const double radius_m = shape.half_size_m.x, half_height_m = shape.half_size_m.y;
    add_patch(mesh, kTrianglesAround, 1, [&](int column, int row) {
        const dvec2 out = radius_m * turn(column, kTrianglesAround);
        const double y = row == 0 ? half_height_m : -half_height_m;
        Vertex corner = corner_of(shape, {out.x, kInside * y, out.y}, {out.x, y, out.y});
        corner.uv.x = double(column) / kTrianglesAround;
        return corner;
    });
    for (const int side : {-1, 1})
        add_patch(mesh, kTrianglesAround, 1, [&](int column, int row) {
            const bool at_rim = (row == 0) == (side < 0);
            const dvec2 out = radius_m * turn(column, kTrianglesAround) * (at_rim ? 1.0 : 0.0);
            const double y = side * half_height_m;
            return corner_of(shape, {kInside * out.x, y, kInside * out.y}, {out.x, y, out.y});
        });
}

Mesh mesh_of(const Shape& shape) {
    Mesh mesh;
    switch (shape.kind) {
        case ShapeKind::plane: add_plane(mesh, shape); break;
        case ShapeKind::disk: add_disk(mesh, shape); break;
        case ShapeKind::sphere: add_sphere(mesh, shape); break;
        case ShapeKind::box: add_box(mesh, shape); break;
        case ShapeKind::cylinder: add_cylinder(mesh, shape); break;
        case ShapeKind::group:
        case ShapeKind::mesh: break;
    }
    return mesh;
}

}  // namespace

Scene triangulated(const Scene& scene) {
    Scene result = scene;
    std::map<std::tuple<ShapeKind, double, double, double>, int> made;
    for (Object& object : result.objects) {
        Shape& shape = object.shape;
        if (shape.kind == ShapeKind::group || shape.kind == ShapeKind::mesh) continue;
        const dvec3& half = shape.half_size_m;
        const auto [entry, is_new] =
            made.emplace(std::tuple(shape.kind, half.x, half.y, half.z), int(result.meshes.size()));
        if (is_new) result.meshes.push_back(mesh_of(shape));
        shape.kind = ShapeKind::mesh;
        shape.mesh = entry->second;
    }
    return result;
}

}  // namespace aftershade::scene
