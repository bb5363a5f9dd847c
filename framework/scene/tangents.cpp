#include "framework/scene/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace aftershade::scene {

using glm::dvec2;
using glm::dvec3;

namespace {

/// Along growing u; of length 0 where the texture has no area. w: 1, or -1 where the texture is mirrored.
glm::dvec4 tangent_of(const Vertex& a, const Vertex& b, const Vertex& c) {
    const dvec3 ab = b.position - a.position, ac = c.position - a.position;
    const dvec2 ab_uv = b.uv - a.uv, ac_uv = c.uv - a.uv;
    const double area = ab_uv.x * ac_uv.y - ab_uv.y * ac_uv.x;
    // v grows down in the picture, but the bitangent points up it.
    const double side = area > 0 ? -1 : 1;
    const dvec3 along = -side * (ac_uv.y * ab - ab_uv.y * ac);
    const double length = glm::length(along);
    if (area == 0 || !(length > 0) || !std::isfinite(length)) return {0, 0, 0, 1};
    return {along / length, side};
}

double angle_at(const dvec3& corner, const dvec3& b, const dvec3& c) {
    const dvec3 to_b = glm::normalize(b - corner), to_c = glm::normalize(c - corner);
    return std::acos(std::clamp(glm::dot(to_b, to_c), -1.0, 1.0));
}

dvec3 unit_or_zero(const dvec3& v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : dvec3(0);
}

}  // namespace

void make_tangents(Mesh& mesh, std::size_t first, int channel) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    mesh.tangents.resize(mesh.vertices.size(), glm::dvec4(0));
    // Of each vertex, itself or a copy for triangles that mirror the texture, and for others.
    std::vector<std::array<std::uint32_t, 2>> of_side(mesh.vertices.size(), {kNone, kNone});
    for (std::size_t i = first; i < mesh.triangles.size(); ++i) {
        std::array<std::uint32_t, 3>& corners = mesh.triangles[i];
        std::array<Vertex, 3> vertices;
        for (std::size_t k = 0; k < 3; ++k) {
            vertices[k] = mesh.vertices[corners[k]];
            vertices[k].uv = mesh.uv(channel, corners[k]);
        }
        const glm::dvec4 tangent = tangent_of(vertices[0], vertices[1], vertices[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t side = tangent.w > 0 ? 1 : 0;
            auto& copies = of_side[corners[k]];
            if (copies[side] == kNone && copies[1 - side] != kNone) {
                copies[side] = mesh.copy_vertex(corners[k]);
                mesh.tangents.emplace_back(0);
            } else if (copies[side] == kNone) {
                copies[side] = corners[k];
            }
            corners[k] = copies[side];
            const dvec3& normal = vertices[k].normal;
            const dvec3 flat = dvec3(tangent) - glm::dot(dvec3(tangent), normal) * normal;
            const double angle_rad = angle_at(vertices[k].position, vertices[(k + 1) % 3].position,
                                              vertices[(k + 2) % 3].position);
            glm::dvec4& sum = mesh.tangents[corners[k]];
            sum = {dvec3(sum) + angle_rad * unit_or_zero(flat), tangent.w};
        }
    }
    for (std::size_t i = first; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t vertex : mesh.triangles[i]) {
            glm::dvec4& tangent = mesh.tangents[vertex];
            tangent = {unit_or_zero(dvec3(tangent)), tangent.w};
        }
}

}  // namespace aftershade::scene
