#include "framework/scene/mesh.h"

namespace aftershade::scene {

Bounds Mesh::bounds() const {
    Bounds bounds;
    for (const Vertex& vertex : vertices) bounds.add(vertex.position);
    return bounds;
}

std::uint32_t Mesh::copy_vertex(std::uint32_t vertex) {
    vertices.push_back(Vertex(vertices[vertex]));
    for (std::vector<glm::dvec2>& uvs : more_uvs) uvs.push_back(glm::dvec2(uvs[vertex]));
    return std::uint32_t(vertices.size() - 1);
}

Bounds transformed(const Bounds& bounds, const glm::dmat4& matrix) {
    Bounds result;
    for (int corner = 0; corner < 8; ++corner)
        result.add(glm::dvec3(matrix * glm::dvec4(corner & 1 ? bounds.high.x : bounds.low.x,
                                                  corner & 2 ? bounds.high.y : bounds.low.y,
                                                  corner & 4 ? bounds.high.z : bounds.low.z, 1)));
    return result;
}

}  // namespace aftershade::scene
