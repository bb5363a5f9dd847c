#include "framework/scene/mesh.h"

namespace aftershade::scene {

Bounds Mesh::bounds() const {
    Bounds bounds;
    for (const Vertex& vertex : vertices) bounds.add(vertex.position);
    return bounds;
}

}  // namespace aftershade::scene
