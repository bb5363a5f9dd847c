// A scene at one moment that rays can be sent into, and the light on what they meet.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "framework/scene/material.h"
#include "framework/scene/scene.h"
#include "framework/scene/scene_state.h"
#include "framework/scene/shape.h"

namespace aftershade::scene {

/// Whether light comes through some of an object's triangles.
struct ObjectAlpha {
    bool has_holes = false;
    bool is_mixed = false;  ///< opacity goes by the triangle or by a texture
};

/// The unmoving part: the meshes' hierarchies. [immutable: any thread]
class Geometry {
public:
    /// `scene` must outlive this.
    explicit Geometry(const Scene& scene);
    const Scene& scene() const { return scene_; }
    const MeshTree& mesh(std::size_t index) const { return meshes_[index]; }
    const MeshTree* mesh_of(const Shape& shape) const {
        return shape.mesh >= 0 ? &meshes_[std::size_t(shape.mesh)] : nullptr;
    }

    const ObjectAlpha& alpha_of(std::size_t object) const { return alphas_[object]; }
    /// A point of an object's triangle, for its textures.
    TexturePoint texture_point(int object, const ShapeHit& hit) const;

private:
    const Scene& scene_;
    std::vector<MeshTree> meshes_;
    std::vector<ObjectAlpha> alphas_;
};

struct Surface {
    glm::dvec3 position{0};          ///< world, m
    glm::dvec3 local{0};             ///< in the object's space
    glm::dvec3 normal{0};            ///< world, unit length, for shading
    glm::dvec3 geometric_normal{0};  ///< world, unit length; both on the side that the ray came from
    glm::dvec2 uv{0};
    glm::dvec2 barycentric{0};   ///< of a mesh, as in ShapeHit
    bool from_behind = false;    ///< whether that is the inside, by the shape's outward normal
    int object = -1;             ///< index into Scene::objects
    std::uint32_t triangle = 0;  ///< of a mesh
    double t = 0;                ///< along the ray
    /// As TexturePoint has it; without one, that of a pixel of the camera.
    std::optional<glm::dmat2> weights_of_pixel;
    double precision = 1e-9;                  ///< of the position, over the size of its coordinates
    std::optional<std::uint32_t> light_seed;  ///< of its random rays; without one, a hash of `local`
};

/// Light at a surface, as the roles of a capture have it.
struct Shading {
    glm::dvec3 irradiance{0};  ///< E / pi
    glm::dvec3 albedo{0};
    glm::dvec3 specular{0};
    glm::dvec3 emission{0};
    glm::dvec3 normal{0};  ///< with the normal map
    glm::dvec3 color() const { return albedo * irradiance + specular + emission; }
};

/// [immutable: any thread]
class World {
public:
    /// `geometry` must outlive this. Textures are filtered over pixels of the camera of this many for each
    /// tangent; 0: not at all.
    World(const Geometry& geometry, SceneState state, double px_per_tangent = 0);

    const SceneState& state() const { return state_; }
    const Scene& scene() const { return geometry_->scene(); }
    glm::dvec3 to_object(int object, const glm::dvec3& position) const;
    Ray to_object(int object, const Ray& ray) const;

    /// The nearest surface with low < t < high; of one object alone where `only` is its index.
    std::optional<Surface> trace(const Ray& ray, double low, double high, int only = -1) const;
    /// Calls visit(surface) for what a ray crosses, the nearest first, until that returns false; at most
    /// kMostCrossings times.
    template <class Visit>
    void cross(const Ray& ray, const Visit& visit) const;
    static constexpr int kMostCrossings = 1024;
    /// The light that comes along a ray: that of each surface by its opacity, through those before it. Adds
    /// to `shadings` how many surfaces that took.
    glm::dvec3 radiance(const Ray& ray, int* shadings = nullptr) const;
    /// The surfaces that a ray hits, the nearest first and at most `most`; without the insides of the opaque
    /// things that it has entered, so that behind a ball's front comes what stands behind the ball.
    std::vector<Surface> trace_through(const Ray& ray, std::size_t most) const;
    /// Whether anything stands between two points.
    bool is_hidden(const glm::dvec3& from, const glm::dvec3& to) const;
    /// The share of light that goes from one point to another past what casts shadows.
    double light_through(const glm::dvec3& from, const glm::dvec3& to) const;
    /// The rest of the ray that met the surface.
    static Ray past(const Surface& surface, const Ray& ray) {
        return {ray.origin + surface.t * kPast * ray.direction, ray.direction};
    }
    /// As a pixel of a ray from `eye` sees it.
    double opacity_of(const Surface& surface, const glm::dvec3& eye) const;
    TexturePoint texture_point(const Surface& surface) const;

    /// A point of an object: by its own space. Normals are outwards.
    Surface surface(int object, const ShapePoint& point) const;
    /// A point of a mesh's triangle, with both normals on the side that is given.
    Surface surface_on(int object, std::uint32_t triangle, const glm::dvec2& barycentric,
                       bool from_behind) const;

    /// E / pi, with shadows.
    glm::dvec3 irradiance(const Surface& surface) const { return light(surface, {}, nullptr, {}).irradiance; }
    /// Writes to `seen`, unless that is empty, which share of each light reaches the surface; 0 of a light
    /// that it faces away from.
    Shading shade(const Surface& surface, const glm::dvec3& eye, std::span<double> seen = {}) const;
    /// Shading::specular alone, the one part that depends on the eye, to the bit and without rays: `seen` is
    /// what shade() wrote. The surface has `weights_of_pixel` if its material has maps.
    glm::dvec3 highlights(const Surface& surface, const glm::dvec3& eye, std::span<const double> seen) const;
    /// Whether any ray that shade() sends from the surface meets one of the boxes. It has
    /// `weights_of_pixel` likewise.
    bool light_meets(const Surface& surface, const Bvh& boxes) const;
    /// An object's bounds in world space; empty where there is nothing to see of it.
    Bounds bounds(int object) const;
    const Material& material_at(const Surface& surface) const {
        return scene().materials[scene().material_at(surface.object, surface.triangle)];
    }

private:
    /// The data of an object that a ray needs, close together.
    struct Seen {
        int object = 0;
        bool casts_shadow = true;
        double opacity = 1;  ///< unless it is mixed
        ObjectAlpha alpha;
        const Shape* shape = nullptr;
        const MeshTree* mesh = nullptr;
        glm::dmat4x3 object_from_world{1};

        Ray local(const Ray& ray) const {
            return {object_from_world * glm::dvec4(ray.origin, 1),
                    glm::dmat3(object_from_world) * ray.direction};
        }
    };
    /// Past a surface, as a ratio of distances: two triangles that share an edge may both be met there.
    static constexpr double kPast = 1 + 1e-7;
    template <class Visit>
    void walk(const Ray& ray, double low, double& high, const Visit& visit) const;
    /// A surface with its normal map applied, and its finish there.
    struct Finished {
        Surface surface;
        Finish finish;
    };
    Finished finished(const Surface& surface, const glm::dvec3& eye) const;
    bool meets_object(const Seen& seen, const Ray& local, double low, double high, bool any,
                      ShapeHit& hit) const;
    glm::dmat2 weights_of_pixel(const Surface& surface, const glm::dvec3& eye) const;
    glm::dvec3 mapped_normal(const Surface& surface, const MaterialMaps& maps, const TexturePoint& at) const;
    /// Light of one source at a surface, as if nothing stood between.
    struct Arriving {
        glm::dvec3 toward{0};    ///< the light's middle
        double received = 0;     ///< E over the light's colour
        double highlighted = 0;  ///< the same for the highlight
    };
    /// Nothing where the surface faces away.
    std::optional<Arriving> arriving(std::size_t light, const Surface& surface) const;
    /// Calls visit(to) for the ends of the rays to a light.
    template <class Visit>
    void visit_shadow_rays(std::size_t light, const Surface& surface, const glm::dvec3& toward,
                           const Visit& visit) const;
    /// Calls visit(way) for the rays of ambient light.
    template <class Visit>
    void visit_ambient_rays(const Surface& surface, const Visit& visit) const;
    Shading light(const Surface& surface, const Finish& finish, const glm::dvec3* to_eye,
                  std::span<double> seen) const;
    double visible_part(std::size_t light, const Surface& surface, const glm::dvec3& toward) const;
    double visible_ambient(const Surface& surface) const;

    const Geometry* geometry_;
    SceneState state_;
    double px_per_tangent_;
    std::vector<int> seen_of_object_;  ///< index into seen_, -1: there is nothing to see of it
    std::vector<Seen> seen_;
    std::vector<Bounds> bounds_;  ///< of seen_, in world space
    Bvh bvh_;                     ///< over them
};

template <class Visit>
void World::cross(const Ray& ray, const Visit& visit) const {
    double low = 0;
    for (int crossing = 0; crossing < kMostCrossings; ++crossing) {
        const auto surface = trace(ray, low, std::numeric_limits<double>::infinity());
        if (!surface || !visit(*surface)) return;
        low = surface->t * kPast;
    }
}

}  // namespace aftershade::scene
