// Rays against shapes, in a shape's own space.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "framework/scene/mesh.h"
#include "framework/scene/scene.h"

namespace aftershade::scene {

struct Ray {
    glm::dvec3 origin{0};
    glm::dvec3 direction{0, 0, -1};  ///< of any length: distances along a ray are multiples of it
};

/// Where on a ray a shape was met.
struct ShapeHit {
    double t = 0;
    std::uint32_t triangle = 0;  ///< of a mesh
    glm::dvec2 barycentric{0};   ///< of a mesh: weights of the triangle's second and third corner
};

/// A point of a shape.
struct ShapePoint {
    glm::dvec3 position{0};
    glm::dvec3 normal{0, 0, 1};            ///< for shading, outwards; need not have unit length
    glm::dvec3 geometric_normal{0, 0, 1};  ///< of the surface itself
    glm::dvec2 uv{0};                      ///< as make_surface_map says
};

/// A triangle by one corner and the two sides that leave it, m.
struct Sides {
    glm::dvec3 corner{0};
    glm::dvec3 to_second{0};
    glm::dvec3 to_third{0};
};

/// A mesh with its hierarchy, whose leaves hold up to four triangles.
struct MeshTree {
    explicit MeshTree(const Mesh& of);
    const Mesh* mesh;  ///< must outlive this
    Bvh bvh;
    std::vector<Sides> sides;  ///< of each of bvh.items, so that a leaf's triangles lie side by side
};

/// Whether the ray meets the box between low and high (Kay and Kajiya 1986). Here, since most of the time of
/// rays among triangles goes by in it.
inline bool meets(const Ray& ray, const glm::dvec3& inverse_direction, const Bounds& bounds, double low,
                  double high) {
    const glm::dvec3* const corners[] = {&bounds.low, &bounds.high};
    double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
    for (int axis = 0; axis < 3; ++axis) {
        const double origin = ray.origin[axis], inverse = inverse_direction[axis];
        const bool back = inverse < 0;
        const double near = ((*corners[back])[axis] - origin) * inverse;
        const double far = ((*corners[!back])[axis] - origin) * inverse;
        // Not a number along a face, and then no bound: a ray along a slab's face is inside it.
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
    }
    return enter <= leave && leave > low && enter < high;
}

/// Where a mesh has no surface although it has a triangle.
class Holes {
public:
    virtual ~Holes() = default;
    virtual bool has(const ShapeHit& hit) const = 0;
};

/// The first point of the shape with low < t < high; false where there is none. `mesh` is that of a mesh.
/// With `any` the first that is found will do. `holes` are a mesh's; null: none.
bool intersect(const Shape& shape, const MeshTree* mesh, const Ray& ray, double low, double high, bool any,
               ShapeHit& hit, const Holes* holes = nullptr);

/// The point of a mesh, by the triangle and its weights alone.
ShapePoint mesh_point(const Mesh& mesh, const ShapeHit& hit);
ShapePoint point_of(const Shape& shape, const MeshTree* mesh, const Ray& ray, const ShapeHit& hit);

/// In object space. Groups have none.
Bounds bounds_of(const Shape& shape, const MeshTree* mesh);

}  // namespace aftershade::scene
