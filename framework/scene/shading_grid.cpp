#include "framework/scene/shading_grid.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/scene/blur_extent.h"
#include "framework/scene/samples.h"
#include "framework/scene/shape.h"

namespace aftershade::scene {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

/// Cells: bounds that are whole cells but for rounding take no cell more.
constexpr double kHardlyMore = 1e-6;

std::array<dvec3, 3> corners_of(const Mesh& mesh, std::uint32_t triangle) {
    const auto& corner = mesh.triangles[triangle];
    return {mesh.vertices[corner[0]].position, mesh.vertices[corner[1]].position,
            mesh.vertices[corner[2]].position};
}

/// Moller and Trumbore 1997, on the triangle's plane; its middle where the ray runs along that.
dvec2 barycentric_on_plane(const Ray& ray, const std::array<dvec3, 3>& corners) {
    const dvec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const dvec3 p = glm::cross(ray.direction, ac), s = ray.origin - corners[0];
    const double scale = glm::dot(ab, p);
    const dvec2 found = dvec2(glm::dot(s, p), glm::dot(ray.direction, glm::cross(s, ab))) / scale;
    return std::isfinite(found.x) && std::isfinite(found.y) ? found : dvec2(1.0 / 3);
}

/// What lies outside comes to the edge.
dvec2 inside_triangle(const dvec2& barycentric) {
    const dvec3 weights =
        glm::max(dvec3(1 - barycentric.x - barycentric.y, barycentric.x, barycentric.y), dvec3(0));
    return dvec2(weights.y, weights.z) / (weights.x + weights.y + weights.z);
}

}  // namespace

ShadingGrids::ShadingGrids(const SceneRenderer& renderer, int frame, const ShadingGridSettings& settings,
                           const FrameGrids* earlier)
    : renderer_(renderer),
      world_(renderer.world_at(frame, frame)),
      of_frame_{frame, {}, {world_.state().camera}} {
    const Scene& scene = renderer.scene();
    const Exposure exposure = exposure_of(scene.camera, frame);
    const std::array<SceneState, 2> ends = {state_at(scene, frame, exposure.first),
                                            state_at(scene, frame, exposure.last)};
    std::vector<TriangleGrid>& all = of_frame_.grids;
    std::optional<KeptGrids> kept;
    if (earlier) kept.emplace(renderer, world_.state(), *earlier);
    std::uint64_t cells = 0;
    for (std::size_t object = 0; object < scene.objects.size(); ++object) {
        first_triangle_.push_back(std::uint32_t(all.size()));
        const int index = scene.objects[object].shape.mesh;
        if (index < 0) continue;
        const Mesh& mesh = scene.meshes[std::size_t(index)];
        for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
            const std::array<dvec3, 3> corners = corners_of(mesh, triangle);
            glm::dmat2 wanted(settings.rate);
            if (settings.anisotropic)
                wanted = settings.rate * cells_from_px_of_blur(renderer, world_.state().camera, ends,
                                                               world_.state().world_from_object[object],
                                                               int(object), corners);
            TriangleGrid grid = grid_of(int(object), corners, wanted, settings.origin);
            if (kept && !kept->has_moved(int(object))) {
                const auto earlier_grid =
                    kept->kept(grid, all.size(), int(object), corners, wanted, of_frame_.cameras);
                grid = earlier_grid ? *earlier_grid
                                    : grid_of(int(object), corners, kFiner * wanted, settings.origin);
            }
            grid.start = std::uint32_t(cells);
            all.push_back(grid);
            cells += std::uint64_t(grid.size.x) * std::uint64_t(grid.size.y);
            if (2 * cells > kMaxShadingIds)
                throw Error(
                    ErrorKind::usage,
                    fmt::format("{}: the triangles of frame {} have more than {} shading samples at a "
                                "shading rate of {}; choose a lower {} or {}",
                                scene.path.string(), frame, kMaxShadingIds, settings.rate,
                                spelled(Option::shading_rate), spelled(Option::size)));
        }
    }
    id_count_ = std::uint32_t(2 * cells);
}

const Mesh& ShadingGrids::mesh_of(int object) const {
    const Scene& scene = renderer_.scene();
    return scene.meshes[std::size_t(scene.objects[std::size_t(object)].shape.mesh)];
}

/// The middle of the picture where a point lies behind the camera: somewhere on the grid.
dvec2 ShadingGrids::reference_px(const dvec3& world, const CameraState& camera) const {
    const dvec2 picture_px(renderer_.width_px(), renderer_.height_px());
    dvec2 px;
    if (!renderer_.project(camera, dvec4(world, 1), px)) return 0.5 * picture_px;
    return glm::clamp(px, -picture_px, 2.0 * picture_px);
}

TriangleGrid ShadingGrids::grid_of(int object, const std::array<dvec3, 3>& corners,
                                   const glm::dmat2& cells_from_px, GridOrigin origin) const {
    const glm::dmat4& world_from_object = world_.state().world_from_object[std::size_t(object)];
    const CameraState& camera = world_.state().camera;
    TriangleGrid grid;
    grid.cells_from_px = cells_from_px;
    const dvec2 picture_px(renderer_.width_px(), renderer_.height_px());
    dvec2 low(1e300), high(-1e300), unused;
    const auto add = [&](const dvec2& px) {
        low = glm::min(low, grid.cells_from_px * px);
        high = glm::max(high, grid.cells_from_px * px);
    };
    for (const dvec3& corner : corners) {
        const dvec4 world = world_from_object * dvec4(corner, 1);
        add(reference_px(dvec3(world), camera));
        if (renderer_.project(camera, world, unused)) continue;
        // What crosses the camera's plane may be anywhere.
        for (const dvec2 part : {dvec2(-1), dvec2(2, -1), dvec2(-1, 2), dvec2(2)}) add(part * picture_px);
    }
    if (origin == GridOrigin::triangle) {
        grid.size = glm::max(glm::ivec2(glm::ceil(high - low - kHardlyMore)), 1);
        const dvec2 fit = dvec2(grid.size) / glm::max(high - low, dvec2(kHardlyMore));
        grid.cells_from_px = glm::dmat2(fit.x, 0, 0, fit.y) * grid.cells_from_px;
        grid.low = low * fit;
    } else {
        grid.low = glm::floor(low);
        grid.size = glm::ivec2(glm::floor(high) - grid.low) + 1;
    }
    return grid;
}

std::uint32_t ShadingGrids::id_of(const Surface& surface) const {
    const TriangleGrid& grid = grids()[first_triangle_[std::size_t(surface.object)] + surface.triangle];
    const glm::dmat4& world_from_object = world_.state().world_from_object[std::size_t(surface.object)];
    const dvec2 px =
        reference_px(dvec3(world_from_object * dvec4(surface.local, 1)), of_frame_.cameras[grid.camera]);
    const glm::ivec2 cell =
        glm::clamp(glm::ivec2(glm::floor(grid.cells_from_px * px - grid.low)), glm::ivec2(0), grid.size - 1);
    return 2 * (grid.start + std::uint32_t(cell.y * grid.size.x + cell.x)) + (surface.from_behind ? 1 : 0);
}

std::uint32_t ShadingGrids::triangle_of(std::uint32_t id) const {
    const auto after =
        std::upper_bound(grids().begin(), grids().end(), id / 2,
                         [](std::uint32_t cell, const TriangleGrid& grid) { return cell < grid.start; });
    return std::uint32_t(after - grids().begin()) - 1;
}

Ray ShadingGrids::ray_through(int object, std::uint32_t triangle, std::uint32_t id, const dvec2& part) const {
    const TriangleGrid& grid = grids()[first_triangle_[std::size_t(object)] + triangle];
    const std::uint32_t cell = id / 2 - grid.start, columns = std::uint32_t(grid.size.x);
    const dvec2 px =
        glm::inverse(grid.cells_from_px) * (grid.low + dvec2(cell % columns, cell / columns) + part);
    return world_.to_object(object, renderer_.camera_ray(of_frame_.cameras[grid.camera], px, dvec2(0)));
}

ShadingPlace ShadingGrids::place_of(std::uint32_t id) const {
    const std::uint32_t index = triangle_of(id);
    // Objects without triangles begin where the next one does.
    const auto object = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), index) - 1;
    ShadingPlace place;
    place.object = int(object - first_triangle_.begin());
    place.triangle = index - *object;
    place.from_behind = (id & 1) != 0;
    place.barycentric =
        inside_triangle(barycentric_on_plane(ray_through(place.object, place.triangle, id, dvec2(0.5)),
                                             corners_of(mesh_of(place.object), place.triangle)));
    return place;
}

dvec2 ShadingGrids::weights_through(const ShadingPlace& place, std::uint32_t id, const dvec2& part) const {
    return barycentric_on_plane(ray_through(place.object, place.triangle, id, part),
                                corners_of(mesh_of(place.object), place.triangle));
}

glm::dmat2 ShadingGrids::weights_of_cell(const ShadingPlace& place, std::uint32_t id) const {
    return {weights_through(place, id, {1, 0.5}) - weights_through(place, id, {0, 0.5}),
            weights_through(place, id, {0.5, 1}) - weights_through(place, id, {0.5, 0})};
}

/// Each place counts as much as it is opaque. `middle` is the cell's: it stands for a cell of which the
/// triangle covers no place.
dvec3 ShadingGrids::mean_albedo(const Surface& middle, std::uint32_t id, const Material& material) const {
    const Mesh& mesh = mesh_of(middle.object);
    const std::array<dvec3, 3> corners = corners_of(mesh, middle.triangle);
    TexturePoint at = world_.texture_point(middle);
    at.weights_of_pixel = middle.weights_of_pixel.value_or(glm::dmat2(0)) / double(kAlbedoPoints);
    dvec3 sum(0);
    double weights = 0;
    for (int i = 0; i < kAlbedoPoints * kAlbedoPoints; ++i) {
        const dvec2 part = (dvec2(i % kAlbedoPoints, i / kAlbedoPoints) + 0.5) / double(kAlbedoPoints);
        const dvec2 barycentric =
            barycentric_on_plane(ray_through(middle.object, middle.triangle, id, part), corners);
        if (barycentric.x < 0 || barycentric.y < 0 || barycentric.x + barycentric.y > 1) continue;
        at.barycentric = barycentric;
        at.uv = mesh_point(mesh, {0, middle.triangle, barycentric}).uv;
        const double weight = is_hole(material, at) ? 0
                              : material.blends && material.opacity > 0
                                  ? opacity_at(material, at) / material.opacity
                                  : 1;
        sum += weight * albedo_at(material, at);
        weights += weight;
    }
    if (weights > 0) return sum / weights;
    at.barycentric = middle.barycentric;
    at.uv = middle.uv;
    return albedo_at(material, at);
}

Surface ShadingGrids::surface_of(std::uint32_t id, std::uint32_t ray_id) const {
    const ShadingPlace place = place_of(id);
    Surface surface = world_.surface_on(place.object, place.triangle, place.barycentric, place.from_behind);
    surface.light_seed = light_seed(ray_id, 0);
    if (world_.material_at(surface).maps.any()) surface.weights_of_pixel = weights_of_cell(place, id);
    return surface;
}

Shading ShadingGrids::shading(std::uint32_t id, std::span<double> seen) const {
    const Surface surface = surface_of(id, id);
    Shading shading = world_.shade(surface, dvec3(world_.state().camera.world_from_camera[3]), seen);
    const Material& material = world_.material_at(surface);
    if (material.checker_cells != dvec2(0) || material.maps.any())
        shading.albedo = mean_albedo(surface, id, material);
    return shading;
}

}  // namespace aftershade::scene
