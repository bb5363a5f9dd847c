#include "framework/scene/scene.h"

#include <algorithm>

namespace aftershade::scene {

bool Scene::has_transparency() const {
    return std::any_of(materials.begin(), materials.end(),
                       [](const Material& material) { return material.is_transparent(); });
}

std::vector<std::size_t> Scene::materials_of(int object) const {
    const Object& of = objects[std::size_t(object)];
    if (!of.has_mesh_materials) return {std::size_t(of.material)};
    const Mesh& mesh = meshes[std::size_t(of.shape.mesh)];
    std::vector<bool> has(materials.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) has[material_at(object, i)] = true;
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < has.size(); ++i)
        if (has[i]) found.push_back(i);
    return found;
}

Shot Scene::shot_of(int frame) const {
    Shot shot;
    for (const int cut : cuts) {
        if (cut <= frame) {
            shot.first = cut;
        } else {
            shot.last = cut - 1;
            break;
        }
    }
    return shot;
}

}  // namespace aftershade::scene
