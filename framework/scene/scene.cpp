#include "framework/scene/scene.h"

#include <algorithm>

namespace aftershade::scene {

bool Scene::has_transparency() const {
    return std::any_of(materials.begin(), materials.end(),
                       [](const Material& material) { return material.opacity < 1; });
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
