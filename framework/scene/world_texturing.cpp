// How textures lie on surfaces.
#include <algorithm>
#include <cmath>

#include "framework/scene/world.h"

namespace aftershade::scene {

using glm::dmat2;
using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

/// The least cosine between view and normal. At 0 the footprint would be infinite.
constexpr double kLeastCosine = 1e-3;

}  // namespace

/// Where the rays through the pixel's neighbours meet the surface's plane, to first order (Igehy 1999,
/// Tracing Ray Differentials).
dmat2 World::weights_of_pixel(const Surface& surface, const dvec3& eye) const {
    if (surface.weights_of_pixel) return *surface.weights_of_pixel;
    const Seen& seen = seen_[std::size_t(seen_of_object_[std::size_t(surface.object)])];
    if (!seen.mesh || px_per_tangent_ <= 0) return dmat2(0);
    const double depth_m = std::abs((state_.camera.camera_from_world * dvec4(surface.position, 1)).z);
    const dvec3& normal = surface.geometric_normal;
    const dvec3 view = (surface.position - eye) / depth_m;
    const double along = std::min(glm::dot(normal, view), -kLeastCosine * glm::length(view));
    const dmat3 linear(seen.object_from_world);
    const Mesh& mesh = *seen.mesh->mesh;
    const auto& corner = mesh.triangles[surface.triangle];
    const Vertex &a = mesh.vertices[corner[0]], &b = mesh.vertices[corner[1]], &c = mesh.vertices[corner[2]];
    const dvec3 ab = b.position - a.position, ac = c.position - a.position, area = glm::cross(ab, ac);
    dmat2 result;
    for (int i = 0; i < 2; ++i) {
        const dvec3 axis(state_.camera.world_from_camera[i]);
        const dvec3 side =
            linear * (depth_m / px_per_tangent_ * (axis - glm::dot(normal, axis) / along * view));
        result[i] = dvec2(glm::dot(glm::cross(side, ac), area), glm::dot(glm::cross(ab, side), area)) /
                    glm::dot(area, area);
    }
    return result;
}

TexturePoint World::texture_point(const Surface& surface) const {
    TexturePoint point;
    point.uv = surface.uv;
    const MeshTree* mesh = seen_[std::size_t(seen_of_object_[std::size_t(surface.object)])].mesh;
    point.mesh = mesh ? mesh->mesh : nullptr;
    point.triangle = surface.triangle;
    point.barycentric = surface.barycentric;
    return point;
}

/// In world space. The tangent is made perpendicular to the normal and of unit length at each point, which
/// MikkTSpace's shaders do not do. A back has the front's normal, reversed (glTF 2.0, 3.9.5).
dvec3 World::mapped_normal(const Surface& surface, const MaterialMaps& maps, const TexturePoint& at) const {
    const dvec3 texel(at.of(maps.normal));
    const Seen& seen = seen_[std::size_t(seen_of_object_[std::size_t(surface.object)])];
    if ((texel.x == 0 && texel.y == 0) || !seen.mesh) return surface.normal;
    const Mesh& mesh = *seen.mesh->mesh;
    const auto& corner = mesh.triangles[surface.triangle];
    const dvec2& on = surface.barycentric;
    const dvec3 weights(1 - on.x - on.y, on);
    dvec3 outwards(0), along(0);
    for (int i = 0; i < 3; ++i) {
        outwards += weights[i] * mesh.vertices[corner[std::size_t(i)]].normal;
        along += weights[i] * dvec3(mesh.tangents[corner[std::size_t(i)]]);
    }
    const dmat3 linear(state_.world_from_object[std::size_t(surface.object)]);
    const double side =
        glm::dot(surface.normal, glm::transpose(dmat3(seen.object_from_world)) * outwards) < 0 ? -1 : 1;
    const dvec3 normal = side * surface.normal;
    along = linear * along;
    along -= glm::dot(along, normal) * normal;
    const double length = glm::length(along);
    if (!(length > 0)) return surface.normal;
    along /= length;
    const dvec3 up = mesh.tangents[corner[0]].w * glm::cross(normal, along);
    const dvec3 bent = maps.normal_scale * (texel.x * along + texel.y * up) + texel.z * normal;
    return glm::length(bent) > 0 ? side * glm::normalize(bent) : surface.normal;
}

}  // namespace aftershade::scene
