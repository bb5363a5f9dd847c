#include "framework/visibility/light_scene.h"

#include <bit>

#include "framework/scene/mesh.h"

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

scene::Bounds bounds_of(const std::array<scene::Vertex, 3>& corners) {
    scene::Bounds bounds;
    for (const scene::Vertex& corner : corners) {
        const dvec3 room = 1e-6 * (1e-3 + glm::abs(corner.position));  // for single precision
        bounds.add(corner.position - room);
        bounds.add(corner.position + room);
    }
    return bounds;
}

GpuLight light_of(const scene::Light& light, const scene::LightState& now) {
    const scene::LightPattern& pattern = light.pattern;
    return {with(now.position_m, double(light.kind)),
            with(now.direction, light.shadows ? light.shadow_samples : 0),
            with(now.half_u_m, double(pattern.kind)),
            with(now.half_v_m, pattern.offset_m),
            with(now.color_intensity, pattern.period_m),
            with(pattern.axis, pattern.amplitude)};
}

static_assert(int(scene::LightKind::point) == 0 && int(scene::LightKind::directional) == 1 &&
                  int(scene::LightKind::area) == 2 && int(scene::LightPattern::Kind::edge) == 1 &&
                  int(scene::LightPattern::Kind::cosine) == 2,
              "as light.glsl has them");

void add_object(LightScene& result, std::vector<GpuBlocker>& blockers, std::vector<scene::Bounds>& bounds,
                const scene::Scene& scene, const scene::ShadingGrids& grids, std::size_t index) {
    const scene::Object& object = scene.objects[index];
    if (object.shape.mesh < 0) return;
    const dmat4& world_from_object = grids.reference().world_from_object[index];
    const dmat3 normal_matrix = glm::transpose(glm::inverse(dmat3(world_from_object)));
    const Placed placed{scene.meshes[std::size_t(object.shape.mesh)], world_from_object, normal_matrix};
    const double opacity = scene.material_of(int(index)).opacity;
    for (std::size_t i = 0; i < placed.mesh.triangles.size(); ++i) {
        const auto corners = corners_of(placed, i);
        const scene::TriangleGrid& grid = grids.grids()[result.surfaces.size()];
        const std::size_t material = scene.material_at(int(index), std::uint32_t(i));
        const GpuSurface& surface = result.surfaces.emplace_back(surface_of(corners, grid, material));
        result.starts.push_back(grid.start);
        if (!object.casts_shadow || opacity <= 0) continue;
        blockers.push_back({vec4(glm::vec3(surface.corner), opacity), surface.to_second, surface.to_third});
        bounds.push_back(bounds_of(corners));
    }
}

}  // namespace

std::vector<GpuLight> gpu_lights(const scene::Scene& scene, const scene::SceneState& now) {
    std::vector<GpuLight> lights;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        lights.push_back(light_of(scene.lights[i], now.lights[i]));
    return lights;
}

LightScene make_light_scene(const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids,
                            std::size_t max_bytes) {
    const scene::Scene& scene = renderer.scene();
    check_triangle_count(scene);
    LightScene result;
    std::vector<GpuBlocker> blockers;
    std::vector<scene::Bounds> bounds;
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        add_object(result, blockers, bounds, scene, grids, i);
    const scene::Bvh bvh = scene::build_bvh(bounds, kLeafSize);
    result.nodes = gpu_nodes(bvh);
    for (const std::uint32_t item : bvh.items) result.blockers.push_back(blockers[item]);
    result.materials = gpu_materials(scene, max_bytes);
    const std::vector<std::array<std::uint32_t, 2>> sources = gpu_sources(scene);
    result.tangents = gpu_tangents(scene, sources);
    for (std::size_t i = 0; i < result.tangents.size(); ++i) {
        vec4& tangent = result.tangents[i];
        const dmat3 linear(grids.reference().world_from_object[sources[i / 3][0]]);
        tangent = with(linear * dvec3(tangent), tangent.w);
    }
    result.lights = gpu_lights(scene, grids.reference());
    return result;
}

}  // namespace aftershade::visibility
