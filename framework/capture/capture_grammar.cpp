#include "framework/capture/capture_grammar.h"

#include <limits>

#include "framework/capture/document_forms.h"
#include "framework/core/grammar_schema.h"
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
    block.others = {{kAovPattern, text()}};
    return grammar::object(std::move(block));
}

Block cryptomatte_block() {
    return {.name = "cryptomatte",
            .keys = {optional("layer", text(), "Default: the only one."),
                     optional("mask", grammar::list(text()), "Objects whose coverage is the role mask.")}};
}

Block make_camera_block() {
    Block block{.name = "camera", .thing = "the camera", .doc = "What is known of the camera."};
    for (const CameraField& field : camera_fields()) {
        ParamSpec spec;
        spec.name = field.name;
        spec.unit = field.unit;
        spec.min = field.min;
        block.keys.push_back(optional(field.name, grammar::literal(spec), field.doc));
    }
    block.keys.push_back(optional("lens_model", grammar::choice(lens_model_names()),
                                  "Whether the circle of confusion is a thin lens's or A f / S1."));
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
        numbers(ParamType::vec3, "position", "m", "Of an area light its centre; world space.");
    const Key direction =
        numbers(ParamType::vec3, "direction", "", "The way that the light shines; of any length.");
    const Key size = numbers(ParamType::vec2, "size", "m", "Its sides.", kMinSize_m);
    return {.name = "light",
            .thing = "the light",
            .doc = "A light of the capture, in world space.",
            .keys = {optional("name", text(), "As messages have it."),
                     numbers(ParamType::vec3, "intensity", "",
                             "W/sr of a point, W/m^2 across a directional light, W/(m^2 sr) of an area.", 0)},
            .selector = "type",
            .kinds = {{.name = "point", .keys = {position}},
                      {.name = "directional", .keys = {direction}},
                      {.name = "area", .keys = {position, direction, size}}},
            .path = "light"};
}

/// Without a main file the colour's own file takes its place.
grammar::Rule frames_rule() {
    const auto check = [](const Node& node, const std::string& thing, Diagnostics& diagnostics) {
        const Node* files = node.find("files");
        if (!node.find("frames") && !(files && files->find("color")))
            diagnostics.error(node.place, thing + " has no 'frames'");
    };
    return grammar::custom_rule({.check = check,
                                 .schema = R"({"anyOf": [{"required": ["frames"]}, {"required": ["files"],
                                     "properties": {"files": {"required": ["color"]}}}]})",
                                 .sentence = "`frames`, or a file for color in `files`."});
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
            {optional("files", files_by_role(),
                      "Patterns of roles that lie in files of their own, beside or instead of frames."),
             optional("frames", text(), "The main files, from this document's folder: `gbuffer_####.exr`."),
             optional("range", range, "Frames that there are; else those on the disk."),
             optional("fps", grammar::number({.above = 0}), "Frames a second.", "24"),
             optional("profile", text(), "Conventions of the producer; auto: found by the file's header.",
                      "\"auto\""),
             optional("view", text(), "Of a multi-view file; default: its first."),
             optional("layer", text(),
                      "Of a file with several layers, such as Blender's view layers; default: its first."),
             optional("color_space", color_space_form(),
                      "Of the stored colours; auto: the profile's, else the file's chromaticities.",
                      "\"auto\""),
             optional("alpha", grammar::choice(alpha_names()),
                      "Of color; opaque: the stored alpha means nothing, and is read as 1.", R"("keep")"),
             optional("channels", decodings(), "Instead of the profile's."),
             optional("camera", grammar::object(capture_camera_block()), "Instead of what the files say."),
             optional("lights", grammar::list(grammar::object(capture_light_block())),
                      "Instead of the files'."),
             optional("cryptomatte", grammar::object(cryptomatte_block()),
                      "Gives the roles mask and object_id."),
             optional("cuts", grammar::list(frame_number), "Frames that begin a shot."),
             optional("subframes", grammar::integer(1, 1024),
                      "N: files N * frame to N * frame + N - 1 are the exposure of one frame.", "1")},
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

const Block& capture_block() {
    static const Block block = make_capture_block();
    return block;
}

std::string capture_schema() {
    return grammar::schema_text("Aftershade capture", capture_block());
}

}  // namespace aftershade
