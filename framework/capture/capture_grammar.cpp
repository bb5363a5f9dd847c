#include "framework/capture/capture_grammar.h"

#include <algorithm>
#include <limits>

#include "framework/capture/deep_layers.h"
#include "framework/capture/document_forms.h"
#include "framework/document/grammar_schema.h"
#include "framework/image/camera.h"
#include "framework/image/image_forms.h"

namespace aftershade {

using grammar::Block;
using grammar::Form;
using grammar::Key;
using grammar::optional;
using grammar::required;
using grammar::text;

namespace {

constexpr double kMinSize_m = 1e-6;

Form files_by_role() {
    Block block{.name = "", .unknown_key = "'{}' is not a role", .type = "file by role"};
    for (const ChannelRole& role : channel_roles())
        block.keys.push_back(optional(role.name, text(), role.meaning));
    block.others = {{aov_pattern(), text()}};
    return grammar::object(std::move(block));
}

Block cryptomatte_block() {
    return {.name = "cryptomatte",
            .keys = {optional("layer", text(),
                              "Which Cryptomatte; default: the one that has the named objects, and of "
                              "several such that of objects."),
                     optional("mask", grammar::list(text()),
                              "Names of objects; the role mask is their coverage.")}};
}

Block make_camera_block() {
    Block block{.name = "camera", .thing = "the camera", .doc = "Camera values."};
    for (const CameraField& field : camera_fields()) {
        ParamSpec spec;
        spec.name = field.name;
        spec.unit = field.unit;
        spec.min = field.min;
        block.keys.push_back(optional(field.name, grammar::literal(spec), field.doc));
    }
    block.keys.push_back(optional("lens_model", grammar::choice(lens_model_names()),
                                  "Circle of confusion of a thin lens, or of a pinhole model (A f / S1)."));
    return block;
}

Block make_light_block() {
    const auto numbers = [](ParamType type, const char* name, const char* unit, const char* doc,
                            std::optional<double> min = {}) {
        ParamSpec spec;
        spec.type = type;
        spec.name = name;
        spec.unit = unit;
        spec.min = min;
        return required(name, grammar::literal(spec, {.has_length = name == std::string("direction")}), doc);
    };
    const Key position =
        numbers(ParamType::vec3, "position", "m", "World space; the centre of an area light.");
    const Key direction =
        numbers(ParamType::vec3, "direction", "", "Direction in which the light shines; any length.");
    const Key size = numbers(ParamType::vec2, "size", "m", "Lengths of the two sides.", kMinSize_m);
    return {
        .name = "light",
        .thing = "the light",
        .doc = "A light of the capture, in world space.",
        .keys = {optional("name", text(), "Name for messages."),
                 numbers(ParamType::vec3, "intensity", "",
                         "RGB: W/sr for a point, W/m^2 for a directional light, W/(m^2 sr) for an area.", 0)},
        .selector = "type",
        .kinds = {{.name = "point", .keys = {position}},
                  {.name = "directional", .keys = {direction}},
                  {.name = "area", .keys = {position, direction, size}}},
        .path = "light"};
}

bool has_picture(const Node& node) {
    const Node* files = node.find("files");
    return node.find("frames") || (files && files->find("color"));
}

/// Without a main file the colour's own file takes its place; or every layer has a picture.
grammar::Rule frames_rule() {
    const auto check = [](const Node& node, const std::string& thing, Diagnostics& diagnostics) {
        const Node* layers = node.find("layers");
        const bool in_layers = layers && std::all_of(layers->items.begin(), layers->items.end(), has_picture);
        if (!has_picture(node) && !in_layers) diagnostics.error(node.place, thing + " has no 'frames'");
    };
    return grammar::custom_rule(
        {.check = check,
         .schema = R"({"anyOf": [{"required": ["frames"]},
             {"required": ["files"], "properties": {"files": {"required": ["color"]}}},
             {"required": ["layers"], "properties": {"layers": {"items": {"anyOf": [{"required": ["frames"]},
                 {"required": ["files"], "properties": {"files": {"required": ["color"]}}}]}}}}]})",
         .sentence =
             "`frames` is required unless `files` has a file for color, here or in each of `layers`."});
}

Block make_layer_block() {
    return {
        .name = "layer",
        .thing = "the layer",
        .doc =
            "One of several pictures, each behind the one before. Keys that it lacks come from the capture.",
        .keys = {optional("frames", text(),
                          "Pattern of its main files; with it, `files` of the capture are not the layer's."),
                 optional("files", files_by_role(),
                          "File patterns of its roles that are stored in separate files."),
                 optional("layer", text(),
                          "Layer of the file, such as a view layer of Blender, or a part's name."),
                 optional("view", text(), "View of a multi-view file."),
                 optional("profile", text(), "Producer profile."),
                 optional("channels", decodings(), "Decoding by role."),
                 optional("alpha", grammar::choice(alpha_names()), "Alpha of its color; opaque: read 1."),
                 optional("holdout", grammar::boolean(),
                          "Whether the surfaces in front are cut out of it; its values are divided by the "
                          "light that these let through.",
                          "false")}};
}

Block make_capture_block() {
    const Form range = frame_range_form("'{}' is not a frame range such as \"1-100x2,120\"");
    const Form frame_number =
        grammar::integer(std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
    return {
        .name = "capture",
        .thing = "the capture",
        .doc = "The document.",
        .keys =
            {optional("files", files_by_role(), "File patterns of roles that are stored in separate files."),
             optional("frames", text(),
                      "Pattern of the main files, relative to this document: `gbuffer_####.exr`."),
             optional("range", range, "Frames to use; default: every file that matches the pattern."),
             optional("fps", grammar::number({.above = 0}), "Frames per second.", "24"),
             optional("profile", text(), "Producer profile; auto: detected from the file's header.",
                      "\"auto\""),
             optional("view", text(), "View of a multi-view file; default: the first."),
             optional("layer", text(),
                      "Layer of a file with several, such as Blender's view layers; default: the first."),
             optional("color_space", color_space_form(),
                      "Primaries of the stored colours, which are light; auto: the profile's, else what the "
                      "file says.",
                      "\"auto\""),
             optional("alpha", grammar::choice(alpha_names()),
                      "Alpha of color; opaque: ignore the stored alpha and read 1.", R"("keep")"),
             optional("channels", decodings(), "Decoding by role, instead of the profile's."),
             optional("camera", grammar::object(capture_camera_block()),
                      "Camera values, instead of the files'."),
             optional("lights", grammar::list(grammar::object(capture_light_block())),
                      "Lights, instead of the files'."),
             optional("cryptomatte", grammar::object(cryptomatte_block()),
                      "Source of the roles mask and object_id."),
             optional(
                 "objects",
                 grammar::map(grammar::integer(0, std::numeric_limits<std::uint32_t>::max()), {.by = "name"}),
                 "Names of the numbers in object_id, for looks that name objects: `{\"head\": 1}`."),
             optional("cuts", grammar::list(frame_number), "First frame of each shot."),
             optional("layers",
                      grammar::list(grammar::object(capture_layer_block()), {.min = 2, .max = kMostLayers}),
                      "Pictures that lie behind one another, the nearest first."),
             optional("deep_layers", grammar::integer(1, kMostLayers),
                      "Most layers that the samples of deep files are reduced to.", "4"),
             optional("subframes", grammar::integer(1, 1024),
                      "Files per frame: files N * frame to N * frame + N - 1 are one exposure.", "1")},
        .rules = {frames_rule()},
        .is_document = true};
}

}  // namespace

const std::vector<std::string>& alpha_names() {
    static const std::vector<std::string> names = {"keep", std::string(kOpaqueAlpha)};
    return names;
}

const Block& capture_camera_block() {
    static const Block block = make_camera_block();
    return block;
}

const Block& capture_light_block() {
    static const Block block = make_light_block();
    return block;
}

const Block& capture_layer_block() {
    static const Block block = make_layer_block();
    return block;
}

const Block& capture_block() {
    static const Block block = make_capture_block();
    return block;
}

std::string capture_schema() {
    return grammar::schema_text("Aftershade capture", capture_block());
}

}  // namespace aftershade
