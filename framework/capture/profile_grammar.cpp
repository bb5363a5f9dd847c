#include "framework/capture/profile_grammar.h"

#include "framework/capture/capture_grammar.h"
#include "framework/core/grammar_schema.h"
#include "framework/core/units.h"
#include "framework/image/camera.h"
#include "framework/image/image_forms.h"

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
        .doc =
            "What tells that a file is the producer's; without any key the profile is chosen by name only.",
        .keys = {
            optional("attributes", grammar::list(text()), "Any of these in the header; `*` is any text."),
            optional("channels", grammar::list(text()), "All of these; `a|b` for alternatives."),
            optional(
                "rewrites", grammar::boolean(),
                "The program also writes other producers' files again: where another profile's attributes "
                "are there too, that profile is chosen.",
                "false")}};
}

Block source_block(const CameraField& field) {
    Block block{.name = "camera",
                .thing = "camera." + field.name,
                .doc = "Where the header has a value of the camera.",
                .keys = {optional("attributes", grammar::list(text()),
                                  "The first of these that is there; `*` is any text.")}};
    if (!field.unit.empty())
        block.keys.push_back(optional(
            "unit", grammar::choice(compatible_units(field.unit)),
            "That the attribute is in; default: the value's own, as in [capture.json](captures.md#camera)."));
    return block;
}

Form camera_sources() {
    Block block{
        .name = "", .unknown_key = "'{}' is not a camera value", .type = "[camera](#camera) by value"};
    for (const CameraField& field : camera_fields())
        block.keys.push_back(optional(field.name, grammar::object(source_block(field)), field.doc));
    return grammar::object(std::move(block));
}

Block fact_block() {
    return {.name = "fact",
            .thing = "the fact",
            .doc = "One thing that is known of the producer.",
            .keys = {required("fact", text(), "What is so."),
                     optional("verified", text(), "The real file that showed it."),
                     required("source", text(), "Who says so.")}};
}

}  // namespace

const Block& profile_block() {
    static const Block block{
        .name = "profile",
        .thing = "the profile",
        .doc = "The document.",
        .keys = {required("id", text(), "What `--profile` and capture.json name it by."),
                 required("summary", text(), "One sentence."),
                 required("detect", grammar::object(detect_block()), "How its files are known."),
                 optional("color_space", color_space_form(),
                          "Of the stored colours; auto: the file's chromaticities.", R"("auto")"),
                 optional("lens_model", grammar::choice(lens_model_names()),
                          "The producer's; default: not known."),
                 required("roles", decodings(), "How stored channels become images."),
                 optional("camera", camera_sources(), "Attributes of the header with values of the camera."),
                 optional("facts", grammar::list(grammar::object(fact_block())),
                          "What is known of the producer.")},
        .is_document = true};
    return block;
}

std::string profile_schema() {
    return grammar::schema_text("Aftershade profile", profile_block());
}

}  // namespace aftershade
