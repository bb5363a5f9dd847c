// A small scene as a document: shapes, materials, lights, a camera with lens and shutter, and how they move.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/scene/animated.h"
#include "framework/scene/material.h"
#include "framework/scene/mesh.h"

namespace aftershade::scene {

/// World and object space: right-handed, y up, metres. A shape stands about its object's origin.
enum class ShapeKind {
    group,  ///< nothing to see: a parent for others
    plane,  ///< a rectangle in xy, seen from both sides; normal +z
    disk,   ///< in xy; normal +z
    sphere,
    box,
    cylinder,  ///< along y, with its caps
    mesh       ///< triangles: a glTF file or a height field
};

struct Shape {
    ShapeKind kind = ShapeKind::group;
    glm::dvec3 half_size_m{0};  ///< plane: x, y; box: x, y, z; sphere and disk: radius in x; cylinder: radius
                                ///< in x, half the height in y
    int mesh = -1;              ///< index into Scene::meshes
};

struct Object {
    std::string name;
    unsigned id = 0;  ///< role object_id; 0 stands for nothing hit
    Shape shape;
    int parent = -1;  ///< index into Scene::objects, always an earlier one
    int material = 0;
    bool has_mesh_materials = false;  ///< triangles have the mesh's; those without one have `material`
    Animated<glm::dvec3> position_m{glm::dvec3(0)};
    Animated<glm::dvec3> rotation_deg{glm::dvec3(0)};  ///< about x, then y, then z
    Animated<glm::dvec3> scale{glm::dvec3(1)};
    bool casts_shadow = true;
    Place place;
};

/// Pattern of a directional light, by the distance along `axis`: for light whose blur has a closed form.
struct LightPattern {
    enum class Kind { none, edge, cosine } kind = Kind::none;
    glm::dvec3 axis{1, 0, 0};  ///< world, unit length
    double offset_m = 0;       ///< edge: lit from here on; cosine: a crest
    double period_m = 1;       ///< cosine
    double amplitude = 1;      ///< cosine: the light is 1 + amplitude * cos(...) times its intensity
};

enum class LightKind { point, directional, area };

struct Light {
    std::string name;
    LightKind kind = LightKind::point;
    Animated<glm::dvec3> position_m{glm::dvec3(0)};  ///< point, area (its centre)
    Animated<glm::dvec3> target_m{glm::dvec3(0)};    ///< directional, area: shines from position to here
    glm::dvec2 size_m{1};                            ///< area: its sides
    glm::dvec3 color{1};
    Animated<double> intensity{1.0};  ///< times color: W/sr of a point, W/m^2 across a directional light,
                                      ///< W/(m^2 sr) of an area light
    bool shadows = true;
    int shadow_samples = 1;  ///< area: a grid of this many a side; 1: hard shadows from its centre
    LightPattern pattern;    ///< directional
};

enum class ShutterPhase { start, center, end };

struct SceneCamera {
    Animated<glm::dvec3> position_m{glm::dvec3(0, 0, 5)};
    Animated<glm::dvec3> target_m{glm::dvec3(0)};
    Animated<double> roll_deg{0.0};  ///< positive turns the picture's content anticlockwise
    Animated<double> focal_length_mm{50.0};
    double sensor_width_mm = 36;
    Animated<double> focus_distance_m{5.0};
    double f_number = 2.8;
    int blades = 0;           ///< 0: a disk
    double rotation_deg = 0;  ///< of the aperture, as DESIGN's lens
    double shutter_angle_deg = 180;
    ShutterPhase shutter_phase = ShutterPhase::center;
};

struct Scene {
    std::filesystem::path path;
    std::string summary;
    int width_px = 480;
    int height_px = 270;
    std::vector<int> frames{1};
    double fps = 24;
    std::vector<int> cuts;  ///< frames that begin a shot, ascending
    SceneCamera camera;
    glm::dvec3 background{0};  ///< radiance where nothing is hit
    glm::dvec3 ambient{0};     ///< radiance from all around: adds to irradiance
    int ambient_rays = 0;      ///< of each surface point, which seek what hides it; 0: nothing does
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Object> objects;
    std::vector<Light> lights;

    Shot shot_of(int frame) const;
    const Material& material_of(int object) const {
        return materials[std::size_t(objects[std::size_t(object)].material)];
    }
    /// The index of the material that light meets at a triangle of the object.
    std::size_t material_at(int object, std::uint32_t triangle) const {
        const Object& of = objects[std::size_t(object)];
        if (!of.has_mesh_materials) return std::size_t(of.material);
        const std::vector<int>& own = meshes[std::size_t(of.shape.mesh)].materials;
        const int index = triangle < own.size() ? own[triangle] : -1;
        return std::size_t(index < 0 ? of.material : index);
    }
    /// Whether any material lets light through.
    bool has_transparency() const;
    /// The materials that triangles of the object have.
    std::vector<std::size_t> materials_of(int object) const;
};

}  // namespace aftershade::scene
