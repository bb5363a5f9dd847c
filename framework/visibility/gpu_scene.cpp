#include "framework/visibility/gpu_scene.h"

#include <fmt/format.h>
#include <bit>
#include <span>

#include "framework/base/error.h"
#include "framework/scene/mesh.h"

namespace aftershade::visibility {

using glm::dvec3;
using glm::dvec4;
using glm::vec4;
using scene::Bounds;

namespace {

constexpr std::size_t kMaxTriangles = std::size_t(1) << 20;
/// Between two of these moments of the exposure a corner strays from its way by less than the way itself.
constexpr int kMoments = 17;

float bits(std::uint32_t value) {
    return std::bit_cast<float>(value);
}

std::array<dvec3, 3> corners_of(const scene::Mesh& mesh, std::size_t triangle) {
    const auto& corner = mesh.triangles[triangle];
    return {mesh.vertices[corner[0]].position, mesh.vertices[corner[1]].position,
            mesh.vertices[corner[2]].position};
}

/// All that the corner passes, and some room for single precision.
void add_way(Bounds& bounds, const std::vector<scene::SceneState>& states, std::size_t object,
             const dvec3& corner) {
    dvec3 before(0);
    for (std::size_t i = 0; i < states.size(); ++i) {
        const dvec3 at(states[i].world_from_object[object] * dvec4(corner, 1));
        const dvec3 room = dvec3(1e-5) * (1.0 + glm::abs(at)) + (i > 0 ? glm::abs(at - before) : dvec3(0));
        bounds.add(at - room);
        bounds.add(at + room);
        before = at;
    }
}

GpuTriangle triangle_of(const scene::TriangleGrid& grid, const scene::SceneState& reference,
                        std::size_t object, const std::array<dvec3, 3>& corners, double opacity,
                        bool casts_shadow) {
    GpuTriangle triangle;
    triangle.corner = with(corners[0], bits(std::uint32_t(object)));
    triangle.to_second = with(corners[1] - corners[0], bits(grid.start));
    triangle.to_third = with(corners[2] - corners[0], float(opacity));
    const glm::dmat4 view_from_object =
        reference.camera.camera_from_world * reference.world_from_object[object];
    for (std::size_t i = 0; i < 3; ++i)
        triangle.view[i] = with(dvec3(view_from_object * dvec4(corners[i], 1)));
    triangle.view[0].w = casts_shadow ? float(opacity) : 0;
    const glm::dmat2& cells = grid.cells_from_px;
    triangle.cells_from_px = vec4(cells[0][0], cells[0][1], cells[1][0], cells[1][1]);
    triangle.grid = vec4(float(grid.low.x), float(grid.low.y), bits(std::uint32_t(grid.size.x)),
                         bits(std::uint32_t(grid.size.y)));
    return triangle;
}

}  // namespace

std::vector<GpuNode> gpu_nodes(const scene::Bvh& bvh) {
    std::vector<GpuNode> nodes;
    for (const scene::BvhNode& node : bvh.nodes)
        nodes.push_back({with(node.bounds.low, bits(node.skip)),
                         with(node.bounds.high, bits(node.first << 3 | node.count))});
    return nodes;
}

void check_triangle_count(const scene::Scene& scene, const scene::ShadingGrids& grids) {
    if (grids.grids().size() <= kMaxTriangles) return;
    throw Error(ErrorKind::usage,
                fmt::format("{}: {} triangles, the limit of visibility by GL is {}; trace them on the CPU",
                            scene.path.string(), grids.grids().size(), kMaxTriangles));
}

GpuScene make_gpu_scene(const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids, int frame) {
    const scene::Scene& scene = renderer.scene();
    check_triangle_count(scene, grids);
    const scene::Exposure exposure = exposure_of(scene.camera, frame);
    std::vector<scene::SceneState> states;
    for (int i = 0; i < kMoments; ++i)
        states.push_back(
            state_at(scene, frame, exposure.first + (exposure.last - exposure.first) * i / (kMoments - 1)));
    std::vector<Bounds> bounds;
    std::vector<GpuTriangle> triangles;
    std::vector<std::array<std::uint32_t, 2>> sources;
    for (std::size_t object = 0; object < scene.objects.size(); ++object) {
        const int index = scene.objects[object].shape.mesh;
        if (index < 0) continue;
        const scene::Mesh& mesh = scene.meshes[std::size_t(index)];
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const std::array<dvec3, 3> corners = corners_of(mesh, i);
            triangles.push_back(triangle_of(grids.grids()[triangles.size()], grids.reference(), object,
                                            corners, scene.material_of(int(object)).opacity,
                                            scene.objects[object].casts_shadow));
            sources.push_back({std::uint32_t(object), std::uint32_t(i)});
            Bounds& own = bounds.emplace_back();
            for (const dvec3& corner : corners) add_way(own, states, object, corner);
        }
    }
    const scene::Bvh bvh = scene::build_bvh(bounds, kLeafSize);
    GpuScene result{gpu_nodes(bvh), {}, {}};
    for (const std::uint32_t item : bvh.items) {
        result.triangles.push_back(triangles[item]);
        result.sources.push_back(sources[item]);
    }
    return result;
}

std::vector<vec4> make_moments(const std::vector<scene::World>& moments) {
    std::vector<vec4> rows;
    for (const scene::World& world : moments)
        for (const glm::dmat4& world_from_object : world.state().world_from_object) {
            const glm::dmat4 across = glm::transpose(glm::inverse(world_from_object));
            for (int row = 0; row < 3; ++row) rows.emplace_back(across[row]);
        }
    return rows;
}

}  // namespace aftershade::visibility
