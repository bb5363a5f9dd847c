#include "framework/capture/profile_grammar.h"

#include "framework/base/option.h"
#include "framework/capture/capture_grammar.h"
#include "framework/document/grammar_schema.h"
#include "framework/document/units.h"
#include "framework/image/camera.h"
#include "framework/image/image_forms.h"
#include "framework/image/role.h"

namespace aftershade {

using grammar::Block;
using grammar::Form;
using grammar::optional;
using grammar::required;
using grammar::text;

namespace {

Block detect_block() {
    return {
        .name = "detect",
        .doc = "How the producer's files are detected; without any key the profile is chosen by name only.",
        .keys = {
            optional(
                "attributes", grammar::list(text()),
                "Header attributes, any of which is enough: `name` or `name=text`; `*` matches any text."),
            optional("channels", grammar::list(text()),
                     "Channels, all of which are required; `a|b` are alternatives."),
            optional(
                "rewrites", grammar::boolean(),
                "The program also writes other producers' files again: where another profile's attributes "
                "are there too, that profile is chosen.",
                "false")}};
}

constexpr const char* kFieldOfViewDoc =
    "Angle of view across the width: it gives `sensor_width` by the focal length, else `focal_length` by the "
    "sensor's width.";

/// As a value of the camera, though no camera holds it.
CameraField field_of_view() {
    return {kFieldOfView, "deg", 0, kFieldOfViewDoc};
}

Block source_block(const CameraField& field) {
    Block block{.name = "camera",
                .thing = "camera." + field.name,
                .doc = "Source of a camera value in the header.",
                .keys = {optional("attributes", grammar::list(text()),
                                  "Attributes; the first that is present counts. `*` matches any text.")}};
    if (counts_in_sensor_widths(field))
        block.keys.push_back(optional("times_sensor_width", grammar::boolean(),
                                      "The attribute counts in widths of the sensor, given in capture.json.",
                                      "false"));
    if (!field.unit.empty())
        block.keys.push_back(optional(
            "unit", grammar::choice(compatible_units(field.unit)),
            "Unit of the attribute; default: the value's unit in [capture.json](captures.md#camera)."));
    return block;
}

Form camera_sources() {
    Block block{
        .name = "", .unknown_key = "'{}' is not a camera value", .type = "[camera](#camera) by value"};
    for (const CameraField& field : camera_fields())
        block.keys.push_back(optional(field.name, grammar::object(source_block(field)), field.doc));
    block.keys.push_back(
        optional(kFieldOfView, grammar::object(source_block(field_of_view())), kFieldOfViewDoc));
    return grammar::object(std::move(block));
}

Form remedies_by_role() {
    Block block{.name = "", .unknown_key = "'{}' is not a role", .type = "text by role"};
    for (const ChannelRole& role : channel_roles())
        block.keys.push_back(optional(role.name, text(), role.meaning));
    return grammar::object(std::move(block));
}

Block fact_block() {
    return {.name = "fact",
            .thing = "the fact",
            .doc = "A fact about the producer's files.",
            .keys = {required("fact", text(), "The fact."),
                     optional("verified", text(), "Real file that shows it."),
                     required("source", text(), "Source of the fact.")}};
}

}  // namespace

bool counts_in_sensor_widths(const CameraField& field) {
    return field.name == "focal_length";
}

const Block& profile_block() {
    static const Block block{
        .name = "profile",
        .thing = "the profile",
        .doc = "The document.",
        .keys = {required("id", text(), "Name for `" + spelled(Option::profile) + "` and capture.json."),
                 required("summary", text(), "One sentence."),
                 required("detect", grammar::object(detect_block()), "How its files are detected."),
                 optional("color_space", color_space_form(),
                          "Primaries of the stored colours, which are light; auto: what the file "
                          "says.",
                          R"("auto")"),
                 optional("lens_model", grammar::choice(lens_model_names()),
                          "Lens model of the producer; default: unknown."),
                 required("roles", decodings(), "How stored channels become images."),
                 optional("remedies", remedies_by_role(),
                          "The producer's settings that write a role, for messages about a capture "
                          "without it: `tick Vector`."),
                 optional("camera", camera_sources(),
                          "Camera values by the header attributes that hold them."),
                 optional(
                     "seen_on", grammar::list(text()),
                     "Real files that tests read with it; none: the profile is from documentation only."),
                 optional("facts", grammar::list(grammar::object(fact_block())),
                          "Facts about the producer's files.")},
        .is_document = true};
    return block;
}

std::string profile_schema() {
    return grammar::schema_text("Aftershade profile", profile_block());
}

}  // namespace aftershade
