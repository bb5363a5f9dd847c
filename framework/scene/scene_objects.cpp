#include <cmath>

#include "framework/base/error.h"
#include "framework/document/units.h"
#include "framework/scene/scene_reader_internal.h"

namespace aftershade::scene {

namespace {

/// In [-1, 1), from a number: pcg of the integer, the output permutation of O'Neill 2014 (RXS M XS, 32 bits).
double signed_hash(std::uint32_t number) {
    const std::uint32_t state = number * 747796405u + 2891336453u;
    const std::uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return double((word >> 22u) ^ word) / 2147483648.0 - 1.0;
}

glm::dvec3 signed_hash3(std::uint32_t number) {
    return {signed_hash(3 * number), signed_hash(3 * number + 1), signed_hash(3 * number + 2)};
}

Animated<glm::dvec3> offset_by(const Animated<glm::dvec3>& value, const glm::dvec3& offset) {
    auto keys = value.keys();
    for (auto& key : keys) key.value += offset;
    return {std::move(keys), value.interpolation()};
}

LightPattern pattern_of(const grammar::Reader& reader) {
    LightPattern pattern;
    pattern.kind = reader.text("type") == "cosine" ? LightPattern::Kind::cosine : LightPattern::Kind::edge;
    pattern.axis = glm::normalize(vec3(reader, "axis"));
    pattern.offset_m = number(reader, "offset");
    pattern.period_m = number(reader, "period");
    pattern.amplitude = number(reader, "amplitude");
    return pattern;
}

}  // namespace

Shape SceneReader::read_shape(const grammar::Reader& reader) {
    Shape shape;
    const std::string name = reader.kind();
    if (name == "plane") {
        shape.kind = ShapeKind::plane;
        shape.half_size_m = glm::dvec3(vec2(reader, "size") * 0.5, 0);
    } else if (name == "disk" || name == "sphere") {
        shape.kind = name == "disk" ? ShapeKind::disk : ShapeKind::sphere;
        shape.half_size_m = glm::dvec3(number(reader, "radius"));
    } else if (name == "box") {
        shape.kind = ShapeKind::box;
        shape.half_size_m = vec3(reader, "size") * 0.5;
    } else if (name == "cylinder") {
        shape.kind = ShapeKind::cylinder;
        const double radius_m = number(reader, "radius");
        shape.half_size_m = {radius_m, number(reader, "height") * 0.5, radius_m};
    } else if (name == "mesh") {
        shape.kind = ShapeKind::mesh;
        shape.mesh = find_name(reader, "mesh", "mesh", meshes_).value_or(-1);
    }
    if (shape.kind == ShapeKind::mesh && shape.mesh >= 0) {
        const Bounds bounds = scene_.meshes[std::size_t(shape.mesh)].bounds();
        if (!bounds.empty()) shape.half_size_m = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    }
    return shape;
}

void SceneReader::read_object(const grammar::Reader& reader) {
    const std::string place = "objects[" + std::to_string(reader.index()) + "]";
    Object object;
    object.place = reader.node().place;
    object.name = reader.text("name");
    object.shape = read_shape(reader);
    object.id = unsigned(integer(reader, "id"));
    if (object.id == 0) object.id = unsigned(reader.index()) + 1;
    object.casts_shadow = flag(reader, "casts_shadow");
    object.position_m = animated_vec3(reader, "position");
    object.rotation_deg = animated_vec3(reader, "rotation");
    object.scale = animated_vec3(reader, "scale");
    object.material = find_name(reader, "material", "material", materials_).value_or(-1);
    const bool is_mesh = object.shape.kind == ShapeKind::mesh;
    object.has_mesh_materials = is_mesh && !reader.has("material");
    // A height field has no file that gives it materials. A mesh that is not there has its own error.
    const Mesh* mesh = object.shape.mesh < 0 ? nullptr : &scene_.meshes[std::size_t(object.shape.mesh)];
    const bool has_file = is_mesh && (!mesh || mesh->triangles.empty() || !mesh->materials.empty());
    if (!reader.node().find("material") && object.shape.kind != ShapeKind::group && !has_file &&
        !materials_.empty())
        diagnostics_.error(object.place, place + " has no material");
    object.parent = find_name(reader, "parent", "earlier object", objects_).value_or(-1);
    if (const auto repeat = reader.object("repeat")) {
        add_repeated(object, *repeat, place + ".repeat.");
        return;
    }
    if (!object.name.empty() && !objects_.emplace(object.name, int(scene_.objects.size())).second)
        diagnostics_.error(reader.place("name"), "two objects are named '" + object.name + "'");
    scene_.objects.push_back(std::move(object));
}

void SceneReader::add_repeated(const Object& object, const grammar::Reader& reader,
                               const std::string& label) {
    const glm::dvec3 count = vec3(reader, "count");
    const glm::dvec3 step_m = vec3(reader, "step");
    const glm::dvec3 scatter_m = vec3(reader, "scatter");
    const glm::dvec3 turn_deg = vec3(reader, "turn");
    const int id_step = integer(reader, "id_step");
    if (const double all = count.x * count.y * count.z; all > double(kMaxObjects)) {
        diagnostics_.error(reader.node().place, label + "count: makes " + format_number(all) +
                                                    " objects, more than " + std::to_string(kMaxObjects));
        return;
    }
    std::uint32_t copy = 0;
    for (int z = 0; z < int(count.z); ++z)
        for (int y = 0; y < int(count.y); ++y)
            for (int x = 0; x < int(count.x); ++x, ++copy) {
                Object one = object;
                one.id += copy * unsigned(id_step);
                one.position_m = offset_by(object.position_m,
                                           glm::dvec3(x, y, z) * step_m + signed_hash3(2 * copy) * scatter_m);
                one.rotation_deg = offset_by(object.rotation_deg, signed_hash3(2 * copy + 1) * turn_deg);
                scene_.objects.push_back(std::move(one));
            }
}

void SceneReader::read_light(const grammar::Reader& reader) {
    const std::string type = reader.kind();
    if (type.empty()) return;
    Light light;
    light.name = reader.has("name") ? reader.text("name") : "light " + std::to_string(reader.index() + 1);
    light.color = vec3(reader, "color");
    light.shadows = flag(reader, "shadows");
    light.kind = type == "point"  ? LightKind::point
                 : type == "area" ? LightKind::area
                                  : LightKind::directional;
    light.position_m = animated_vec3(reader, "position");
    light.intensity = animated_number(reader, "intensity");
    if (light.kind != LightKind::point) {
        light.target_m = animated_vec3(reader, "target");
        if (light.position_m.at(scene_.frames.front()) == light.target_m.at(scene_.frames.front()))
            diagnostics_.error(reader.node().place,
                               "lights[" + std::to_string(reader.index()) +
                                   "]: position and target are one point, which gives no direction");
    }
    if (light.kind == LightKind::area) {
        light.size_m = vec2(reader, "size");
        light.shadow_samples = integer(reader, "shadow_samples");
    }
    if (light.kind == LightKind::directional)
        if (const auto pattern = reader.object("pattern")) light.pattern = pattern_of(*pattern);
    scene_.lights.push_back(std::move(light));
}

}  // namespace aftershade::scene
