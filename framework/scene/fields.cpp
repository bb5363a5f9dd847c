#include "framework/scene/fields.h"

#include <string>
#include <utility>

#include "framework/capture/document_forms.h"
#include "framework/scattering/scattering_grammar.h"

namespace aftershade::scene {

namespace {

using grammar::Block;
using grammar::Form;
using grammar::Key;

constexpr double kFar_m = 1e6;
/// A cut is a frame of this number at most, either side of 0.
constexpr int kMaxCut = 1000000;
/// parse_frame_range() takes nine digits.
constexpr int kMaxFrame = 999999999;

/// A literal, until it is a key.
struct Field {
    ParamSpec spec;
    grammar::LiteralForms forms{.still = true};
    bool is_required = false;
    operator Key() const { return grammar::field(spec, forms, is_required); }
    operator Form() const { return grammar::literal(spec, forms); }
};

Field make(ParamType type, std::string name, std::string unit, ParamValue value, std::string doc) {
    Field field;
    field.spec.type = type;
    field.spec.name = std::move(name);
    field.spec.unit = std::move(unit);
    field.spec.default_value = std::move(value);
    field.spec.doc = std::move(doc);
    return field;
}

Field plain_number(std::string name, std::string unit, double value, double min, double max,
                   std::string doc) {
    Field field = make(ParamType::float_, std::move(name), std::move(unit), value, std::move(doc));
    field.spec.min = min;
    field.spec.max = max;
    return field;
}

Field integer(std::string name, int value, int min, int max, std::string doc) {
    Field field = make(ParamType::int_, std::move(name), "", std::int64_t(value), std::move(doc));
    field.spec.min = min;
    field.spec.max = max;
    return field;
}

Field vector(ParamType type, std::string name, std::string unit, std::vector<double> value, double min,
             double max, std::string doc) {
    Field field = make(type, std::move(name), std::move(unit), std::move(value), std::move(doc));
    field.spec.min = min;
    field.spec.max = max;
    return field;
}

Field color(std::string name, double value, double max, std::string doc) {
    Field field =
        vector(ParamType::color, std::move(name), "", {value, value, value}, 0, max, std::move(doc));
    field.forms.uniform = true;
    return field;
}

Field place(std::string name, std::vector<double> value, std::string doc) {
    return vector(ParamType::vec3, std::move(name), "m", std::move(value), -kFar_m, kFar_m, std::move(doc));
}

Field flag(std::string name, bool value, std::string doc) {
    return make(ParamType::bool_, std::move(name), "", value, std::move(doc));
}

Field choice(std::string name, std::vector<std::string> values, std::string doc) {
    Field field = make(ParamType::enum_, std::move(name), "", values.front(), std::move(doc));
    field.spec.values = std::move(values);
    return field;
}

Field animated(Field field) {
    field.forms.animated = true;
    return field;
}

Field required(Field field) {
    field.is_required = true;
    return field;
}

Field uniform(Field field) {
    field.forms.uniform = true;
    return field;
}

Field whole(Field field) {
    field.forms.whole = true;
    return field;
}

Field never(Field field, std::vector<double> values) {
    field.forms.never = std::move(values);
    return field;
}

Field with_length(Field field) {
    field.forms.has_length = true;
    return field;
}

Key or_block(const Field& field, Block block) {
    Key key = field;
    key.form = grammar::any_of({field, grammar::object(std::move(block))});
    return key;
}

Key name_key(std::string doc) {
    return grammar::optional("name", grammar::text(), std::move(doc));
}

/// The name of something that the document declares.
Form name_of(const std::string& block) {
    return grammar::text({.type = "name of a declared [" + block + "](#" + block + ")"});
}

Form object_of(Block block) {
    return grammar::object(std::move(block));
}

/// An object that others refer to in the schema.
Block shared(Block block) {
    block.definition = block.name;
    return block;
}

Field radius() {
    return required(plain_number("radius", "m", 1, 1e-6, kFar_m, "Radius."));
}

Field albedo() {
    return color("albedo", 0.8, 1, "Share of the light that is reflected to all sides.");
}

Block camera_block() {
    return shared(
        {.name = "camera",
         .thing = "the camera",
         .doc = "A perspective camera with a thin lens; y is up.",
         .keys = {
             animated(place("position", {0, 0, 5}, "Position of the lens.")),
             animated(place("target", {0, 0, 0}, "Point that the middle of the picture shows.")),
             animated(
                 plain_number("roll", "deg", 0, -36000, 36000, "Turns the picture's content anticlockwise.")),
             animated(plain_number("focal_length", "mm", 50, 0.1, 10000,
                                   "Focal length; with the sensor's width it sets the angle of view.")),
             plain_number("sensor_width", "mm", 36, 0.1, 1000,
                          "Width of the sensor, which is as wide as the picture."),
             animated(plain_number("focus_distance", "m", 5, 0.01, kFar_m,
                                   "Distance along the view axis to the plane in focus.")),
             plain_number("f_number", "", 2.8, 0.05, 1000,
                          "Focal length divided by the aperture's diameter."),
             never(integer("blades", 0, 0, 32,
                           "Number of the aperture's corners; 0 is a disk; 1 and 2 are not allowed."),
                   {1, 2}),
             plain_number(
                 "rotation", "deg", 0, -36000, 36000,
                 "Rotation of the aperture; 0 puts the middle of a straight edge at +x, positive turns +x "
                 "towards +y (down).")}});
}

Block shutter_block() {
    return shared(
        {.name = "shutter",
         .thing = "the shutter",
         .doc = "Exposure, for the truth of motion blur and for sub-frames.",
         .keys = {plain_number("angle", "deg", 180, 0, 360, "Shutter angle; 360 is the whole frame."),
                  choice("phase", {"center", "start", "end"},
                         "Part of the exposure that is the frame's own time.")}});
}

Block checker_block() {
    return shared(
        {.name = "checker",
         .thing = "the albedo",
         .doc = "Squares of two colours over the texture coordinates.",
         .keys = {required(vector(ParamType::vec2, "cells", "", {8, 8}, 1e-6, 65536,
                                  "Number of squares along u and v.")),
                  grammar::required(
                      "checker",
                      grammar::list(albedo(), {.min = 2, .max = 2, .fault = "a checker has two colours"}),
                      "The two colours.")}});
}

Block material_block() {
    return shared(
        {.name = "material",
         .thing = "the material '{}'",
         .doc = "Lambert's diffuse reflection and a GGX highlight.",
         .keys = {or_block(albedo(), checker_block()),
                  plain_number("roughness", "", 0.5, 0.03, 1,
                               "Roughness of the highlight; GGX alpha is its square."),
                  plain_number("specular", "", 0.04, 0, 1,
                               "Reflectance at normal incidence, by Schlick; 0 for no highlight."),
                  color("emission", 0, 1e9, "Radiance that the surface emits."),
                  plain_number("opacity", "", 1, 0, 1,
                               "Share of the light that each crossing of the surface stops."),
                  grammar::optional("scattering_profile", grammar::scattering_profile(),
                                    "Profile by which light enters the surface and comes out nearby.")}});
}

Block wave_block() {
    return shared(
        {.name = "wave",
         .thing = "the wave",
         .doc = "amplitude * cos(2 pi (x, y) . cycles + phase), metres.",
         .keys = {required(plain_number("amplitude", "m", 0, -kFar_m, kFar_m, "Height of the crest.")),
                  required(vector(ParamType::vec2, "cycles", "", {1, 0}, -1e6, 1e6,
                                  "Number of waves per metre along x and y.")),
                  plain_number("phase", "deg", 0, -1e6, 1e6, "Phase at the origin.")}});
}

Block height_field_block() {
    return shared({.name = "height_field",
                   .thing = "the height field",
                   .doc = "A sheet over xy, raised along z by the sum of its waves.",
                   .keys = {required(vector(ParamType::vec2, "size", "m", {1, 1}, 1e-6, kFar_m,
                                            "Lengths along x and y.")),
                            integer("segments", 64, 1, 1024, "Number of squares along each side."),
                            grammar::optional("waves", grammar::list(object_of(wave_block())),
                                              "Waves to add up; none: flat.")}});
}

Block mesh_block() {
    return shared(
        {.name = "mesh",
         .thing = "the mesh '{}'",
         .doc = "Triangles for objects, from a file or a height field.",
         .keys = {grammar::optional("file", grammar::text({.type = "path from the document's folder"}),
                                    "glTF 2.0, .gltf or .glb."),
                  grammar::optional("height_field", object_of(height_field_block()), "A sheet of waves.")},
         .rules = {grammar::exactly_one_of({"file", "height_field"},
                                           "a mesh has either a 'file' or a 'height_field'")}});
}

Block repeat_block() {
    return shared(
        {.name = "repeat",
         .thing = "the repetition",
         .doc = "The object several times, along a grid in its parent's space.",
         .keys = {required(whole(vector(ParamType::vec3, "count", "", {1, 1, 1}, 1, 4096,
                                        "Number of copies along x, y and z; the product is at most " +
                                            std::to_string(kMaxObjects) + "."))),
                  place("step", {1, 1, 1}, "Distance from one copy to the next along each axis."),
                  uniform(vector(ParamType::vec3, "scatter", "m", {0, 0, 0}, 0, kFar_m,
                                 "Largest shift of a copy, by a hash of its number.")),
                  vector(ParamType::vec3, "turn", "deg", {0, 0, 0}, 0, 360,
                         "Largest turn of a copy in either direction, by a hash of its number."),
                  integer("id_step", 0, 0, 4096, "Difference of the ids from one copy to the next.")}});
}

std::vector<Block> shapes() {
    const auto size = [](const char* doc) {
        return required(vector(ParamType::vec2, "size", "m", {1, 1}, 1e-6, kFar_m, doc));
    };
    return {
        {.name = "group", .doc = "An invisible parent for other objects."},
        {.name = "plane",
         .doc = "A rectangle in xy, seen from both sides; its normal is +z.",
         .keys = {size("Lengths along x and y.")}},
        {.name = "disk", .doc = "A disk in xy, seen from both sides; its normal is +z.", .keys = {radius()}},
        {.name = "sphere", .doc = "Centred on its origin.", .keys = {radius()}},
        {.name = "box",
         .doc = "Centred on its origin.",
         .keys = {required(uniform(
             vector(ParamType::vec3, "size", "m", {1, 1, 1}, 1e-6, kFar_m, "Lengths along x, y and z.")))}},
        {.name = "cylinder",
         .doc = "A cylinder along y around its origin, with its caps.",
         .keys = {radius(), required(plain_number("height", "m", 1, 1e-6, kFar_m, "Length along y."))}},
        {.name = "mesh",
         .doc = "A mesh of the scene's \"meshes\".",
         .keys = {grammar::required("mesh", name_of("mesh"), "Which.")}}};
}

Block object_block() {
    return shared(
        {.name = "object",
         .doc = "A shape with a material that may move.",
         .keys = {animated(place("position", {0, 0, 0}, "Position of its origin, in its parent's space.")),
                  animated(vector(ParamType::vec3, "rotation", "deg", {0, 0, 0}, -1e6, 1e6,
                                  "Rotation about x, then y, then z.")),
                  animated(uniform(vector(ParamType::vec3, "scale", "", {1, 1, 1}, 1e-6, 1e6,
                                          "Scale along its own axes."))),
                  integer(
                      "id", 0, 0, 16777215,
                      "Value in the role object_id; 0 stands for the object's place in the list, from 1."),
                  flag("casts_shadow", true, "Whether the object casts shadows on others."),
                  name_key("Name for \"parent\"; it is unique among objects without \"repeat\"."),
                  grammar::optional(
                      "material", name_of("material"),
                      "Material. Groups, and scenes without \"materials\", need none; a mesh without one "
                      "has the materials of its file."),
                  grammar::optional("parent", name_of("object"),
                                    "An earlier object, without \"repeat\", that it moves with."),
                  grammar::optional("repeat", object_of(repeat_block()),
                                    "Grid of copies of the object; such an object cannot be a parent.")},
         .selector = "shape",
         .kinds = shapes()});
}

Block pattern_block() {
    return shared(
        {.name = "pattern",
         .thing = "the pattern",
         .doc = "Pattern of a directional light, by the distance along an axis.",
         .keys = {required(choice("type", {"edge", "cosine"},
                                  "edge: dark below the offset; cosine: 1 + amplitude * cos.")),
                  with_length(vector(ParamType::vec3, "axis", "", {1, 0, 0}, -1, 1,
                                     "Axis in world space, of any length.")),
                  plain_number("offset", "m", 0, -kFar_m, kFar_m,
                               "edge: distance from which the light shines; cosine: distance of a crest."),
                  plain_number("period", "m", 1, 1e-9, kFar_m, "cosine: distance from crest to crest."),
                  plain_number("amplitude", "", 1, 0, 1, "cosine.")}});
}

std::vector<Block> light_types() {
    const auto intensity = [](const char* doc) {
        return animated(plain_number("intensity", "", 1, 0, 1e12, doc));
    };
    const auto position = [](const char* doc) {
        return animated(required(place("position", {0, 5, 0}, doc)));
    };
    const auto target = [](const char* doc) { return animated(place("target", {0, 0, 0}, doc)); };
    return {{.name = "point",
             .doc = "Light from one point to all sides.",
             .keys = {position("Position of the light."), intensity("W/sr.")}},
            {.name = "directional",
             .doc = "Light from far away, in one direction.",
             .keys = {position("Start of the line to the target along which the light shines."),
                      target("End of that line."), intensity("W/m^2 across the light."),
                      grammar::optional("pattern", object_of(pattern_block()),
                                        "Pattern that the light shines through.")}},
            {.name = "area",
             .doc = "A rectangle that shines from its front only; it is not visible itself.",
             .keys = {position("Centre of the rectangle."), target("Point that its front faces."),
                      intensity("Radiance, W/(m^2 sr)."),
                      vector(ParamType::vec2, "size", "m", {1, 1}, 1e-6, kFar_m,
                             "Lengths of its sides; the first side is level."),
                      integer("shadow_samples", 1, 1, 16,
                              "Points along each side of the grid that casts shadows; 1: hard shadows from "
                              "the centre.")}}};
}

Block light_block() {
    return shared({.name = "light",
                   .doc = "Light of a colour and an intensity.",
                   .keys = {color("color", 1, 1e9, "Colour, multiplied by the intensity."),
                            flag("shadows", true, "Whether objects cast shadows in its light."),
                            name_key("Name in captures and messages.")},
                   .selector = "type",
                   .kinds = light_types()});
}

/// Where there are materials, everything that is seen has one or a file that may give one; SceneReader checks
/// it, object by object.
grammar::Rule materials_rule() {
    return grammar::custom_rule({.check = {}, .schema = R"({
        "if": {"required": ["materials"], "properties": {"materials": {"minProperties": 1}}},
        "then": {"properties": {"objects": {"items": {"anyOf": [
            {"properties": {"shape": {"enum": ["group", "mesh"]}}}, {"required": ["material"]}]}}}}})"});
}

Block make_scene_block() {
    const std::string frames_fault = "frames are a range such as \"1-24\" or \"1-100x2,120\"";
    const Form frames = grammar::any_of(
        {frame_range_form(frames_fault), grammar::integer(-kMaxFrame, kMaxFrame)}, frames_fault);
    return {
        .name = "scene",
        .thing = "the scene",
        .doc = "The document.",
        .keys =
            {plain_number("fps", "", 24, 0.001, 1000, "Frames a second."),
             whole(vector(ParamType::vec2, "size", "", {480, 270}, 1, 16384, "Size of the picture, px.")),
             color("background", 0, 1e9, "Radiance where nothing is hit."),
             color("ambient", 0, 1e9, "Radiance from all sides."),
             integer("ambient_rays", 0, 0, kMaxAmbientRays,
                     "Rays by which each surface point finds what hides the ambient light; 0: nothing does."),
             grammar::optional("summary", grammar::text(), "One sentence."),
             grammar::optional("frames", frames, "Frames to render; default: 1."),
             grammar::optional("cuts", grammar::list(grammar::integer(-kMaxCut, kMaxCut), {.unique = true}),
                               "Frames that begin a shot, each listed once."),
             grammar::required("camera", object_of(camera_block()), "Camera that sees the scene."),
             grammar::optional("shutter", object_of(shutter_block()), "Exposure of a frame."),
             grammar::optional("materials", grammar::map(object_of(material_block())),
                               "Materials of objects."),
             grammar::optional("meshes", grammar::map(object_of(mesh_block())),
                               "Triangles for objects with the shape mesh."),
             grammar::required("objects", grammar::list(object_of(object_block()), {.max = int(kMaxObjects)}),
                               "Visible objects, and groups."),
             grammar::optional("lights", grammar::list(object_of(light_block()), {.max = int(kMaxLights)}),
                               "Light sources.")},
        .rules = {materials_rule()},
        .is_document = true};
}

}  // namespace

const Block& scene_block() {
    static const Block block = make_scene_block();
    return block;
}

}  // namespace aftershade::scene
