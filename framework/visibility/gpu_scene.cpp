#include "framework/visibility/gpu_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <bit>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/scene/mesh.h"

namespace aftershade::visibility {

using glm::dvec3;
using glm::dvec4;
using glm::vec4;
using scene::Bounds;

namespace {

constexpr std::size_t kMaxTriangles = std::size_t(1) << 20;
constexpr double kMaxLength_m = 1e9;  // whose fourth power single precision still holds

float bits(std::uint32_t value) {
    return std::bit_cast<float>(value);
}

/// Some room for single precision.
Bounds with_room(const Bounds& bounds) {
    return {bounds.low - 1e-5 * (1.0 + glm::abs(bounds.low)),
            bounds.high + 1e-5 * (1.0 + glm::abs(bounds.high))};
}

GpuNode gpu_node(const Bounds& bounds, std::uint32_t skip, std::uint32_t items) {
    return {with(bounds.low, bits(skip)), with(bounds.high, bits(items))};
}

/// Nodes and triangles of meshes, until both are complete.
struct Meshes {
    std::vector<GpuNode> nodes;
    std::vector<vec4> triangles;
};

/// The mesh's nodes and triangles behind those that are there.
GpuObject add_mesh(Meshes& all, const scene::MeshTree& tree) {
    GpuObject object;
    object.first_node = std::uint32_t(all.nodes.size());
    object.node_count = std::uint32_t(tree.bvh.nodes.size());
    object.first_triangle = std::uint32_t(all.triangles.size() / 3);
    // The items of a leaf have three bits of their word in bvh.glsl, their index 29.
    for (const scene::BvhNode& node : tree.bvh.nodes)
        all.nodes.push_back(gpu_node(with_room(node.bounds), node.skip, node.first << 3 | node.count));
    for (std::size_t i = 0; i < tree.bvh.items.size(); ++i) {
        const scene::Sides& sides = tree.sides[i];
        for (const vec4& row :
             {with(sides.corner, bits(tree.bvh.items[i])), with(sides.to_second), with(sides.to_third)})
            all.triangles.push_back(row);
    }
    return object;
}

void check_triangle_count(const scene::Scene& scene) {
    std::size_t count = 0;
    for (const scene::Object& object : scene.objects)
        if (object.shape.mesh >= 0) count += scene.meshes[std::size_t(object.shape.mesh)].triangles.size();
    if (count <= kMaxTriangles) return;
    throw Error(
        ErrorKind::usage,
        fmt::format("{}: {} triangles, the limit of visibility by GL is {}; choose {}", scene.path.string(),
                    count, kMaxTriangles, spelled(Option::visibility_on, "cpu")));
}

void check_size(const scene::Scene& scene, std::size_t object, const Bounds& bounds) {
    const dvec3 far = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    if (bounds.empty() || glm::all(glm::lessThanEqual(far, dvec3(kMaxLength_m)))) return;
    const double worst_m = std::max({far.x, far.y, far.z});
    throw Error(ErrorKind::usage,
                fmt::format("{}: object '{}' reaches {} m, the limit of visibility by GL is {}; choose {}",
                            scene.path.string(), scene.objects[object].name, worst_m, kMaxLength_m,
                            spelled(Option::visibility_on, "cpu")));
}

GpuGrid gpu_grid(const scene::TriangleGrid& grid, const glm::dmat4& view_from_object, const scene::Mesh& mesh,
                 std::size_t triangle) {
    GpuGrid result;
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3& corner = mesh.vertices[mesh.triangles[triangle][i]].position;
        result.view[i] = with(dvec3(view_from_object * dvec4(corner, 1)));
    }
    result.view[0].w = bits(grid.start);
    const glm::dmat2& cells = grid.cells_from_px;
    result.cells_from_px = vec4(cells[0][0], cells[0][1], cells[1][0], cells[1][1]);
    result.grid = vec4(float(grid.low.x), float(grid.low.y), bits(std::uint32_t(grid.size.x)),
                       bits(std::uint32_t(grid.size.y)));
    return result;
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> gpu_sources(const scene::Scene& scene) {
    std::vector<std::array<std::uint32_t, 2>> sources;
    for (std::uint32_t object = 0; object < scene.objects.size(); ++object)
        if (const int mesh = scene.objects[object].shape.mesh; mesh >= 0)
            for (std::uint32_t i = 0; i < scene.meshes[std::size_t(mesh)].triangles.size(); ++i)
                sources.push_back({object, i});
    return sources;
}

GpuScene make_gpu_scene(const scene::SceneRenderer& renderer) {
    const scene::Scene& scene = renderer.scene();
    check_triangle_count(scene);
    GpuScene result;
    Meshes all;
    std::vector<GpuObject> of_mesh;
    std::vector<bool> is_used(scene.meshes.size());
    for (const scene::Object& object : scene.objects)
        if (object.shape.mesh >= 0) is_used[std::size_t(object.shape.mesh)] = true;
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        of_mesh.push_back(is_used[i] ? add_mesh(all, renderer.geometry().mesh(i)) : GpuObject());
    for (const GpuNode& node : all.nodes)
        result.meshes.insert(result.meshes.end(), {node.low_skip, node.high_items});
    result.triangles_at = std::uint32_t(result.meshes.size());
    result.meshes.insert(result.meshes.end(), all.triangles.begin(), all.triangles.end());
    std::uint32_t surfaces = 0;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& from = scene.objects[i];
        GpuObject& object = result.objects.emplace_back();
        if (from.shape.mesh < 0) continue;
        check_size(scene, i, scene::bounds_of(from.shape, renderer.geometry().mesh_of(from.shape)));
        object = of_mesh[std::size_t(from.shape.mesh)];
        object.first_surface = surfaces;
        object.opacity = float(scene.material_of(int(i)).opacity);
        const scene::ObjectAlpha& alpha = renderer.geometry().alpha_of(i);
        object.flags =
            (from.casts_shadow ? 1u : 0u) | (alpha.has_holes ? 2u : 0u) | (alpha.is_mixed ? 4u : 0u);
        surfaces += std::uint32_t(scene.meshes[std::size_t(from.shape.mesh)].triangles.size());
    }
    return result;
}

std::vector<GpuNode> make_top(const scene::SceneRenderer& renderer,
                              const std::vector<scene::World>& moments) {
    const scene::Scene& scene = renderer.scene();
    std::vector<Bounds> bounds;
    std::vector<std::uint32_t> objects;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Shape& shape = scene.objects[i].shape;
        if (shape.mesh < 0 || scene.meshes[std::size_t(shape.mesh)].triangles.empty()) continue;
        const Bounds own = scene::bounds_of(shape, renderer.geometry().mesh_of(shape));
        Bounds all;
        for (const scene::World& world : moments)
            all.add(scene::transformed(own, world.state().world_from_object[i]));
        check_size(scene, i, all);
        bounds.push_back(with_room(all));
        objects.push_back(std::uint32_t(i));
    }
    const scene::Bvh bvh = scene::build_bvh(bounds, 1);
    std::vector<GpuNode> nodes;
    for (const scene::BvhNode& node : bvh.nodes) {
        const std::uint32_t items = node.count > 0 ? objects[bvh.items[node.first]] << 3 | 1u : 0u;
        nodes.push_back(gpu_node(node.bounds, node.skip, items));
    }
    return nodes;
}

std::vector<GpuGrid> make_gpu_grids(const scene::Scene& scene, const scene::ShadingGrids& grids) {
    std::vector<GpuGrid> result;
    const scene::SceneState& reference = grids.reference();
    for (const auto& [object, triangle] : gpu_sources(scene)) {
        const glm::dmat4 view_from_object =
            reference.camera.camera_from_world * reference.world_from_object[object];
        const scene::Mesh& mesh = scene.meshes[std::size_t(scene.objects[object].shape.mesh)];
        result.push_back(gpu_grid(grids.grids()[result.size()], view_from_object, mesh, triangle));
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

static_assert(int(scene::LightKind::point) == 0 && int(scene::LightKind::directional) == 1 &&
                  int(scene::LightKind::area) == 2 && int(scene::LightPattern::Kind::edge) == 1 &&
                  int(scene::LightPattern::Kind::cosine) == 2,
              "as light.glsl has them");

void add_lights(std::vector<vec4>& rows, const scene::Scene& scene, const scene::SceneState& now) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const scene::Light& light = scene.lights[i];
        const scene::LightState& at = now.lights[i];
        const scene::LightPattern& pattern = light.pattern;
        rows.insert(rows.end(),
                    {with(at.position_m, double(light.kind)),
                     with(at.direction, light.shadows ? light.shadow_samples : 0),
                     with(at.half_u_m, double(pattern.kind)), with(at.half_v_m, pattern.offset_m),
                     with(at.color_intensity, pattern.period_m), with(pattern.axis, pattern.amplitude)});
    }
}

}  // namespace aftershade::visibility
