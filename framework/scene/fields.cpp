#include "framework/scene/fields.h"

#include <utility>

namespace aftershade::scene {

namespace {

constexpr double kFar_m = 1e6;

Field make(ParamType type, std::string name, std::string unit, ParamValue value, std::string doc) {
    Field field;
    field.spec.type = type;
    field.spec.name = std::move(name);
    field.spec.unit = std::move(unit);
    field.spec.default_value = std::move(value);
    field.spec.doc = std::move(doc);
    return field;
}

Field number(std::string name, std::string unit, double value, double min, double max, std::string doc) {
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
    field.uniform = true;
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
    field.animated = true;
    return field;
}

Field required(Field field) {
    field.required = true;
    return field;
}

Field uniform(Field field) {
    field.uniform = true;
    return field;
}

Field whole(Field field) {
    field.whole = true;
    return field;
}

Field never(Field field, std::vector<double> values) {
    field.never = std::move(values);
    return field;
}

Field or_block(Field field, std::string block) {
    field.block = std::move(block);
    return field;
}

Field with_length(Field field) {
    field.has_length = true;
    return field;
}

using Form = Part::Form;

Part required(Part part) {
    part.required = true;
    return part;
}

Part name_part(std::string doc) {
    return {"name", Form::text, "", std::move(doc)};
}

Field radius() {
    return required(number("radius", "m", 1, 1e-6, kFar_m, "Radius."));
}

}  // namespace

const Block& camera_block() {
    static const Block block = {
        "camera",
        "A perspective camera with a thin lens; y is up.",
        {animated(place("position", {0, 0, 5}, "The lens.")),
         animated(place("target", {0, 0, 0}, "The point in the middle of the picture.")),
         animated(number("roll", "deg", 0, -36000, 36000, "Turns the picture's content anticlockwise.")),
         animated(number("focal_length", "mm", 50, 0.1, 10000,
                         "With the sensor's width it gives the angle of view.")),
         number("sensor_width", "mm", 36, 0.1, 1000, "Sensor, as wide as the picture."),
         animated(
             number("focus_distance", "m", 5, 0.01, kFar_m, "Along the view axis to the plane in focus.")),
         number("f_number", "", 2.8, 0.05, 1000, "Focal length over the aperture's diameter."),
         never(integer("blades", 0, 0, 32, "Corners of the aperture; 0 is a disk, 1 and 2 are not polygons."),
               {1, 2}),
         number("rotation", "deg", 0, -36000, 36000,
                "Of the aperture; 0 puts the middle of a straight edge at +x, positive turns +x towards +y "
                "(down).")}};
    return block;
}

const Block& shutter_block() {
    static const Block block = {
        "shutter",
        "When light is let in, for the truth of motion blur and for sub-frames.",
        {number("angle", "deg", 180, 0, 360, "360 is the whole frame."),
         choice("phase", {"center", "start", "end"}, "Which part of the exposure is the frame's own time.")}};
    return block;
}

const Block& material_block() {
    static const Block block = {
        "material",
        "Lambert's diffuse reflection and a GGX highlight.",
        {or_block(color("albedo", 0.8, 1, "Share of the light that is reflected to all sides."), "checker"),
         number("roughness", "", 0.5, 0.03, 1, "The highlight's; GGX alpha is its square."),
         number("specular", "", 0.04, 0, 1,
                "Reflectance at normal incidence, by Schlick; 0 for no highlight."),
         color("emission", 0, 1e9, "Radiance that it gives off.")},
        {{"scattering_profile", Form::scattering, "", "Light goes in and comes out nearby."}}};
    return block;
}

const Block& checker_block() {
    static const Block block = {
        "checker",
        "Squares of two colours over the texture coordinates.",
        {required(vector(ParamType::vec2, "cells", "", {8, 8}, 1e-6, 65536, "Squares along u and v."))},
        {{"checker", Form::values, "albedo", "The two colours.", true, 2, 2}}};
    return block;
}

const Block& mesh_block() {
    static const Block block = {"mesh",
                                "Triangles for objects: of a file or a height field, one of the two.",
                                {},
                                {{"file", Form::file, "", "glTF 2.0, .gltf or .glb."},
                                 {"height_field", Form::object, "height_field", "A sheet of waves."}}};
    return block;
}

const Block& object_block() {
    static const Block block = {
        "object",
        "A shape with a material that may move.",
        {animated(place("position", {0, 0, 0}, "Of its origin, in its parent's space.")),
         animated(
             vector(ParamType::vec3, "rotation", "deg", {0, 0, 0}, -1e6, 1e6, "About x, then y, then z.")),
         animated(uniform(vector(ParamType::vec3, "scale", "", {1, 1, 1}, 1e-6, 1e6, "Along its own axes."))),
         integer("id", 0, 0, 16777215, "The role object_id; 0 takes the object's place in the list, from 1."),
         flag("casts_shadow", true, "Whether it stands between lights and others.")},
        {name_part("For \"parent\"; no two without \"repeat\" have the same."),
         {"material", Form::name, "material",
          "What it is made of; a group may do without, and a scene that declares none."},
         {"parent", Form::name, "object", "An earlier object, without \"repeat\", that it moves with."},
         {"repeat", Form::object, "repeat", "Makes a grid of it, which no parent can be."}}};
    return block;
}

const std::vector<Block>& shape_blocks() {
    static const std::vector<Block> blocks = {
        {"group", "Nothing to see: a parent for others.", {}},
        {"plane",
         "A rectangle in xy, seen from both sides; its normal is +z.",
         {required(vector(ParamType::vec2, "size", "m", {1, 1}, 1e-6, kFar_m, "Along x and y."))}},
        {"disk", "In xy, seen from both sides; its normal is +z.", {radius()}},
        {"sphere", "About its origin.", {radius()}},
        {"box",
         "About its origin.",
         {required(
             uniform(vector(ParamType::vec3, "size", "m", {1, 1, 1}, 1e-6, kFar_m, "Along x, y and z.")))}},
        {"cylinder",
         "Along y about its origin, with its caps.",
         {radius(), required(number("height", "m", 1, 1e-6, kFar_m, "Along y."))}},
        {"mesh",
         "Triangles of the scene's \"meshes\".",
         {},
         {required({"mesh", Form::name, "mesh", "Which."})}}};
    return blocks;
}

const Block& height_field_block() {
    static const Block block = {
        "height_field",
        "A sheet over xy, raised along z by the sum of its waves.",
        {required(vector(ParamType::vec2, "size", "m", {1, 1}, 1e-6, kFar_m, "Along x and y.")),
         integer("segments", 64, 1, 1024, "Squares along each side.")},
        {{"waves", Form::list, "wave", "What is added up; none: flat."}}};
    return block;
}

const Block& wave_block() {
    static const Block block = {
        "wave",
        "amplitude * cos(2 pi (x, y) . cycles + phase), metres.",
        {required(number("amplitude", "m", 0, -kFar_m, kFar_m, "Height of the crest.")),
         required(
             vector(ParamType::vec2, "cycles", "", {1, 0}, -1e6, 1e6, "Waves in a metre along x and y.")),
         number("phase", "deg", 0, -1e6, 1e6, "At the origin.")}};
    return block;
}

const Block& repeat_block() {
    static const Block block = {
        "repeat",
        "The object several times, along a grid in its parent's space.",
        {required(
             whole(vector(ParamType::vec3, "count", "", {1, 1, 1}, 1, 4096,
                          "Along x, y and z; the product is at most " + std::to_string(kMaxObjects) + "."))),
         place("step", {1, 1, 1}, "From one to the next along each axis."),
         uniform(vector(ParamType::vec3, "scatter", "m", {0, 0, 0}, 0, kFar_m,
                        "Moves each by up to this much, by a hash of its number.")),
         vector(ParamType::vec3, "turn", "deg", {0, 0, 0}, 0, 360,
                "Turns each by up to this much either way."),
         integer("id_step", 0, 0, 4096, "What the id grows by from one to the next.")}};
    return block;
}

const Block& light_block() {
    static const Block block = {"light",
                                "Light of a colour and an intensity.",
                                {color("color", 1, 1e9, "Times intensity."),
                                 flag("shadows", true, "Whether objects stand in its way.")},
                                {name_part("As captures and messages have it.")}};
    return block;
}

const std::vector<Block>& light_blocks() {
    const auto intensity = [](const char* doc) { return animated(number("intensity", "", 1, 0, 1e12, doc)); };
    const auto position = [](const char* doc) {
        return animated(required(place("position", {0, 5, 0}, doc)));
    };
    const auto target = [](const char* doc) { return animated(place("target", {0, 0, 0}, doc)); };
    static const std::vector<Block> blocks = {
        {"point", "From one point to all sides.", {position("Where it stands."), intensity("W/sr.")}},
        {"directional",
         "From far away.",
         {position("It shines along the line from here to the target."), target("Where that line goes."),
          intensity("W/m^2 across the light.")},
         {{"pattern", Form::object, "pattern", "What it shines through."}}},
        {"area",
         "A rectangle that shines from its front alone; it is not seen itself.",
         {position("Its centre."), target("What its front faces."), intensity("Radiance, W/(m^2 sr)."),
          vector(ParamType::vec2, "size", "m", {1, 1}, 1e-6, kFar_m, "Its sides; the first is level."),
          integer("shadow_samples", 1, 1, 16,
                  "Shadows from a grid of this many points a side; 1: hard ones from the centre.")}}};
    return blocks;
}

const Block& pattern_block() {
    static const Block block = {
        "pattern",
        "What a directional light shines through, by the distance along an axis.",
        {required(
             choice("type", {"edge", "cosine"}, "edge: dark below the offset; cosine: 1 + amplitude * cos.")),
         with_length(
             vector(ParamType::vec3, "axis", "", {1, 0, 0}, -1, 1, "World; need not have unit length.")),
         number("offset", "m", 0, -kFar_m, kFar_m, "edge: lit from here on; cosine: a crest."),
         number("period", "m", 1, 1e-9, kFar_m, "cosine: from crest to crest."),
         number("amplitude", "", 1, 0, 1, "cosine.")}};
    return block;
}

const Block& scene_block() {
    static const Block block = {
        "scene",
        "The document.",
        {number("fps", "", 24, 0.001, 1000, "Frames a second."),
         whole(vector(ParamType::vec2, "size", "", {480, 270}, 1, 16384, "Of the picture, px.")),
         color("background", 0, 1e9, "Radiance where nothing is hit."),
         color("ambient", 0, 1e9, "Radiance from all sides, without shadows.")},
        {{"summary", Form::text, "", "One sentence."},
         {"frames", Form::frame_range, "", "What is rendered; default 1."},
         {"cuts", Form::frames, "", "Frames that begin a shot; each stands once."},
         required({"camera", Form::object, "camera", "Sees the scene."}),
         {"shutter", Form::object, "shutter", "When light is let in."},
         {"materials", Form::by_name, "material", "What objects are made of."},
         {"meshes", Form::by_name, "mesh", "Triangles for objects of the shape mesh."},
         {"objects", Form::list, "object", "What is seen.", true, 0, int(kMaxObjects)},
         {"lights", Form::list, "light", "What shines.", false, 0, int(kMaxLights)}}};
    return block;
}

}  // namespace aftershade::scene
