#include <algorithm>

#include "framework/base/parallel.h"
#include "framework/image/role.h"
#include "framework/scene/capture_images.h"
#include "framework/scene/scene_renderer.h"
#include "framework/scene/surface_map.h"

namespace aftershade::scene {

using glm::dvec3;

Capture SceneRenderer::render_texture_space(int frame, int object, int side_px) const {
    const Shape& shape = scene_.objects[std::size_t(object)].shape;
    const MeshTree* mesh = geometry_.mesh_of(shape);
    const SurfaceMap map = make_surface_map(shape, mesh ? mesh->mesh : nullptr, side_px);
    const World world = world_at(frame, frame);
    std::vector<std::string> roles(all_roles().begin(), all_roles().end());
    std::erase_if(roles, [](const std::string& role) {
        const RoleKind kind = kind_of_role(role);
        return kind == RoleKind::distance || kind == RoleKind::motion;
    });
    Capture capture = make_capture(frame, side_px, side_px, roles);
    capture.header.camera = capture_camera(scene_, world.state(), width_px_, height_px_);
    // The matrices would tell where in this picture a point is, which they do not know.
    capture.header.camera.camera_from_world.reset();
    capture.header.camera.ndc_from_world.reset();
    const dvec3 eye(world.state().camera.world_from_camera[3]);
    for_each_row(side_px, threads_, [&](int y) {
        for (int x = 0; x < side_px; ++x) {
            if (map.position.at(x, y, 3) == 0) continue;
            ShapePoint point;
            for (int c = 0; c < 3; ++c) {
                point.position[c] = map.position.at(x, y, c);
                point.normal[c] = point.geometric_normal[c] = map.normal.at(x, y, c);
            }
            point.uv = {(x + 0.5) / side_px, (y + 0.5) / side_px};
            Surface surface = world.surface(object, point);
            surface.precision = 1e-6;  // the map holds floats
            if (mesh) {
                surface.triangle = map.triangle.uint_at(x, y, 0);
                surface.barycentric = {map.weights.at(x, y, 0), map.weights.at(x, y, 1)};
                const auto& corner = mesh->mesh->triangles[surface.triangle];
                const glm::dvec2 uv = mesh->mesh->uv(0, corner[0]);
                surface.weights_of_pixel = glm::inverse(glm::dmat2(mesh->mesh->uv(0, corner[1]) - uv,
                                                                   mesh->mesh->uv(0, corner[2]) - uv)) /
                                           double(side_px);
            }
            write_surface(capture, x, y, scene_, surface, world.shade(surface, eye));
        }
    });
    return capture;
}

}  // namespace aftershade::scene
