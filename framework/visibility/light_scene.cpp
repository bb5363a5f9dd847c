#include "framework/visibility/light_scene.h"

#include <bit>

#include "framework/scene/mesh.h"
#include "framework/visibility/gpu_scene.h"

namespace aftershade::visibility {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;
using glm::vec4;

namespace {

/// An object as its triangles need it.
struct Placed {
    const scene::Mesh& mesh;
    dmat4 world_from_object;
    dmat3 normal_matrix;
};

/// The corners of a triangle in world space.
std::array<scene::Vertex, 3> corners_of(const Placed& placed, std::size_t triangle) {
    const auto& corner = placed.mesh.triangles[triangle];
    std::array<scene::Vertex, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = placed.mesh.vertices[corner[i]];
        corners[i].position = dvec3(placed.world_from_object * dvec4(corners[i].position, 1));
        corners[i].normal = placed.normal_matrix * corners[i].normal;
    }
    return corners;
}

GpuSurface surface_of(const std::array<scene::Vertex, 3>& corners, const scene::TriangleGrid& grid,
                      std::size_t material) {
    const auto& [a, b, c] = corners;
    GpuSurface surface;
    surface.corner = with(a.position, std::bit_cast<float>(std::uint32_t(material)));
    surface.to_second = with(b.position - a.position, a.uv.y);
    surface.to_third = with(c.position - a.position, b.uv.y);
    for (std::size_t i = 0; i < 3; ++i) surface.normals[i] = with(corners[i].normal, corners[i].uv.x);
    const glm::dmat2 px_from_cells = glm::inverse(grid.cells_from_px);
    surface.px_from_cells = {px_from_cells[0][0], px_from_cells[0][1], px_from_cells[1][0],
                             px_from_cells[1][1]};
    surface.grid = {grid.low.x, grid.low.y, std::bit_cast<float>(std::uint32_t(grid.size.x)), c.uv.y};
    return surface;
}

void add_object(LightSurfaces& result, const scene::Scene& scene, const scene::ShadingGrids& grids,
                std::size_t index) {
    const scene::Object& object = scene.objects[index];
    if (object.shape.mesh < 0) return;
    const dmat4& world_from_object = grids.reference().world_from_object[index];
    const dmat3 normal_matrix = glm::transpose(glm::inverse(dmat3(world_from_object)));
    const Placed placed{scene.meshes[std::size_t(object.shape.mesh)], world_from_object, normal_matrix};
    for (std::size_t i = 0; i < placed.mesh.triangles.size(); ++i) {
        const scene::TriangleGrid& grid = grids.grids()[result.surfaces.size()];
        const std::size_t material = scene.material_at(int(index), std::uint32_t(i));
        result.surfaces.push_back(surface_of(corners_of(placed, i), grid, material));
        result.starts.push_back(grid.start);
    }
}

}  // namespace

LightSurfaces make_light_surfaces(const scene::Scene& scene, const scene::ShadingGrids& grids) {
    LightSurfaces result;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) add_object(result, scene, grids, i);
    return result;
}

}  // namespace aftershade::visibility
