#include <cmath>

#include "framework/core/error.h"
#include "framework/core/units.h"
#include "framework/scene/scene_reader.h"

namespace aftershade::scene {

using Presence = ObjectReader::Presence;

namespace {

std::vector<std::string> names_of(std::span<const Block> blocks) {
    std::vector<std::string> names;
    for (const Block& block : blocks) names.push_back(block.name);
    return names;
}

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

}  // namespace

void SceneReader::read_objects(const Node& node) {
    for (std::size_t i = 0; i < node.items.size(); ++i) read_object(node.items[i], i);
    if (scene_.objects.size() > kMaxObjects)
        diagnostics_.error(node.place, std::to_string(scene_.objects.size()) + " objects are more than " +
                                           std::to_string(kMaxObjects));
}

Shape SceneReader::read_shape(ObjectReader& reader, FieldReader& fields) {
    Shape shape;
    static const std::vector<std::string> names = names_of(shape_blocks());
    const auto name = reader.choice("shape", names, Presence::required);
    if (!name) return shape;
    const Block& block = *find_block(shape_blocks(), *name);
    if (*name == "plane") {
        shape.kind = ShapeKind::plane;
        shape.half_size_m = glm::dvec3(fields.vec2(block, "size") * 0.5, 0);
    } else if (*name == "disk" || *name == "sphere") {
        shape.kind = *name == "disk" ? ShapeKind::disk : ShapeKind::sphere;
        shape.half_size_m = glm::dvec3(fields.number(block, "radius"));
    } else if (*name == "box") {
        shape.kind = ShapeKind::box;
        shape.half_size_m = fields.vec3(block, "size") * 0.5;
    } else if (*name == "cylinder") {
        shape.kind = ShapeKind::cylinder;
        const double radius_m = fields.number(block, "radius");
        shape.half_size_m = {radius_m, fields.number(block, "height") * 0.5, radius_m};
    } else if (*name == "mesh") {
        shape.kind = ShapeKind::mesh;
        if (const Node* mesh = reader.any("mesh", Presence::required))
            shape.mesh = find_name(*mesh, "mesh", meshes_).value_or(-1);
    }
    if (shape.kind == ShapeKind::mesh && shape.mesh >= 0) {
        const Bounds bounds = scene_.meshes[std::size_t(shape.mesh)].bounds();
        if (!bounds.empty()) shape.half_size_m = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    }
    return shape;
}

void SceneReader::read_object(const Node& node, std::size_t index) {
    const std::string place = "objects[" + std::to_string(index) + "]";
    ObjectReader reader(node, place, diagnostics_);
    if (!reader.is_object()) return;
    FieldReader fields(reader, place + ".", diagnostics_);
    Object object;
    object.place = node.place;
    object.name = reader.text("name").value_or("");
    object.shape = read_shape(reader, fields);
    object.id = unsigned(fields.integer(object_block(), "id"));
    if (object.id == 0) object.id = unsigned(index) + 1;
    object.casts_shadow = fields.flag(object_block(), "casts_shadow");
    object.position_m = fields.animated_vec3(object_block(), "position");
    object.rotation_deg = fields.animated_vec3(object_block(), "rotation");
    object.scale = fields.animated_vec3(object_block(), "scale");
    if (const Node* material = reader.any("material"))
        object.material = find_name(*material, "material", materials_).value_or(0);
    else if (object.shape.kind != ShapeKind::group && !scene_.materials.empty())
        diagnostics_.error(node.place, place + " has no material");
    if (const Node* parent = reader.any("parent"))
        object.parent = find_name(*parent, "earlier object", objects_).value_or(-1);
    const Node* repeat = reader.object("repeat");
    reader.finish();
    if (repeat) {
        add_repeated(object, *repeat, place + ".repeat.");
        return;
    }
    if (!object.name.empty() && !objects_.emplace(object.name, int(scene_.objects.size())).second)
        diagnostics_.error(node.find("name")->place, "two objects are named '" + object.name + "'");
    scene_.objects.push_back(std::move(object));
}

void SceneReader::add_repeated(const Object& object, const Node& node, const std::string& label) {
    ObjectReader reader(node, "the repetition", diagnostics_);
    FieldReader fields(reader, label, diagnostics_);
    const Block& block = repeat_block();
    const glm::dvec3 count = fields.vec3(block, "count");
    const glm::dvec3 step_m = fields.vec3(block, "step");
    const glm::dvec3 scatter_m = fields.vec3(block, "scatter");
    const glm::dvec3 turn_deg = fields.vec3(block, "turn");
    const int id_step = fields.integer(block, "id_step");
    reader.finish();
    if (const double all = count.x * count.y * count.z; all > double(kMaxObjects)) {
        diagnostics_.error(node.place, label + "count: makes " + format_number(all) + " objects, more than " +
                                           std::to_string(kMaxObjects));
        return;
    }
    std::uint32_t number = 0;
    for (int z = 0; z < int(count.z); ++z)
        for (int y = 0; y < int(count.y); ++y)
            for (int x = 0; x < int(count.x); ++x, ++number) {
                Object one = object;
                one.id += number * unsigned(id_step);
                one.position_m = offset_by(
                    object.position_m, glm::dvec3(x, y, z) * step_m + signed_hash3(2 * number) * scatter_m);
                one.rotation_deg = offset_by(object.rotation_deg, signed_hash3(2 * number + 1) * turn_deg);
                scene_.objects.push_back(std::move(one));
            }
}

void SceneReader::read_lights(const Node& node) {
    for (std::size_t i = 0; i < node.items.size(); ++i) read_light(node.items[i], i);
    if (scene_.lights.size() > kMaxLights)
        diagnostics_.error(node.place, std::to_string(scene_.lights.size()) + " lights are more than " +
                                           std::to_string(kMaxLights));
}

void SceneReader::read_light(const Node& node, std::size_t index) {
    const std::string place = "lights[" + std::to_string(index) + "]";
    ObjectReader reader(node, place, diagnostics_);
    if (!reader.is_object()) return;
    FieldReader fields(reader, place + ".", diagnostics_);
    static const std::vector<std::string> types = names_of(light_blocks());
    Light light;
    light.name = reader.text("name").value_or("light " + std::to_string(index + 1));
    const auto type = reader.choice("type", types, Presence::required);
    light.color = fields.vec3(light_block(), "color");
    light.shadows = fields.flag(light_block(), "shadows");
    if (!type) {
        reader.finish();
        return;
    }
    const Block& block = *find_block(light_blocks(), *type);
    light.kind = *type == "point"  ? LightKind::point
                 : *type == "area" ? LightKind::area
                                   : LightKind::directional;
    light.position_m = fields.animated_vec3(block, "position");
    light.intensity = fields.animated_number(block, "intensity");
    if (light.kind != LightKind::point) {
        light.target_m = fields.animated_vec3(block, "target");
        if (light.position_m.at(scene_.frames.front()) == light.target_m.at(scene_.frames.front()))
            diagnostics_.error(node.place,
                               place + ": position and target are one point, which gives no direction");
    }
    if (light.kind == LightKind::area) {
        light.size_m = fields.vec2(block, "size");
        light.shadow_samples = fields.integer(block, "shadow_samples");
    }
    if (light.kind == LightKind::directional)
        if (const Node* pattern = reader.object("pattern"))
            light.pattern = read_pattern(*pattern, place + ".pattern.");
    reader.finish();
    scene_.lights.push_back(std::move(light));
}

LightPattern SceneReader::read_pattern(const Node& node, const std::string& label) {
    ObjectReader reader(node, "the pattern", diagnostics_);
    FieldReader fields(reader, label, diagnostics_);
    LightPattern pattern;
    pattern.kind = fields.choice(pattern_block(), "type") == "edge" ? LightPattern::Kind::edge
                                                                    : LightPattern::Kind::cosine;
    pattern.axis = glm::normalize(fields.vec3(pattern_block(), "axis"));
    pattern.offset_m = fields.number(pattern_block(), "offset");
    pattern.period_m = fields.number(pattern_block(), "period");
    pattern.amplitude = fields.number(pattern_block(), "amplitude");
    reader.finish();
    return pattern;
}

}  // namespace aftershade::scene
