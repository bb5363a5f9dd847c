// Rays against shapes, in a shape's own space.
#pragma once

#include <glm/glm.hpp>

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

/// A mesh with its hierarchy, whose leaves hold up to four triangles.
struct MeshTree {
    explicit MeshTree(const Mesh& of);
    const Mesh* mesh;  ///< must outlive this
    Bvh bvh;
};

/// Whether the ray meets the box between low and high.
bool meets(const Ray& ray, const glm::dvec3& inverse_direction, const Bounds& bounds, double low,
           double high);

/// The first point of the shape with low < t < high; false where there is none. `mesh` is that of a mesh.
/// With `any` the first that is found will do.
bool intersect(const Shape& shape, const MeshTree* mesh, const Ray& ray, double low, double high, bool any,
               ShapeHit& hit);

ShapePoint point_of(const Shape& shape, const MeshTree* mesh, const Ray& ray, const ShapeHit& hit);

/// In object space. Groups have none.
Bounds bounds_of(const Shape& shape, const MeshTree* mesh);

}  // namespace aftershade::scene
