#include "framework/look/look_grammar.h"

#include <nlohmann/json.hpp>

#include "framework/base/text.h"
#include "framework/document/schema_pieces.h"
#include "framework/image/image_forms.h"

namespace aftershade {

using grammar::Block;
using grammar::Form;
using grammar::optional;
using grammar::required;
using grammar::text;

namespace {

/// The name of a step: the wiring means the input by "capture", and only check_names() knows every name.
Form step_name() {
    return text({.pattern = {"^(?!capture$)[a-z][a-z0-9_]*$",
                             [](const std::string& name) { return is_snake_case(name); }},
                 .fault = std::string("the name '{}' ") + kMustBeSnakeCase,
                 .type = "name"});
}

Form any_object(const std::string& type) {
    return grammar::map(grammar::custom({.type = type}));
}

/// Objects are read, and refused, by whoever reads the mask.
Form objects() {
    const Form one =
        grammar::custom({.type = "[entry](params.md#objects)", .schema = schema::object_key().dump()});
    return grammar::any_of({one, grammar::list(one, {.min = 1, .max = int(kMaxMaskObjects)})});
}

Block make_mask_block() {
    return {.name = "mask",
            .thing = "the mask",
            .doc = "Where the step applies: a role with one channel, objects, or a picture.",
            .keys = {optional("role", role_form(), "Role of the capture with one channel."),
                     optional("object", objects(), "Objects, by the role object_id."),
                     optional("file", text({.min_length = 1, .type = "path from the look's folder"}),
                              "Picture over the display window."),
                     optional("invert", grammar::boolean(), "Applies the step everywhere else.", "false")},
            .rules = {grammar::exactly_one_of({"role", "object", "file"},
                                              "a mask has one of 'role', 'object' and 'file'")},
            .definition = "Mask"};
}

}  // namespace

Form look_wire() {
    const auto check = [](const Node& node, const grammar::Spot& spot, Diagnostics& diagnostics) {
        if (!node.is_string() || node.string.find('.') == std::string::npos)
            diagnostics.error(
                node.place,
                "'" + spot.key +
                    "' comes from \"capture.<role>\", \"<step>.<output>\" or \"<step>.<texture>\"");
    };
    return grammar::custom({.type = "`step.output`, `step.texture` or `capture.role`",
                            .schema = R"({"type": "string",
                                "pattern": "^([a-z][a-z0-9_]*\\.[a-z][a-z0-9_]*|capture\\.aov:.+)$"})",
                            .check = check});
}

const Block& look_mask_block() {
    static const Block block = make_mask_block();
    return block;
}

const Block& look_step_block() {
    static const Block block{
        .name = "step",
        .thing = "the step",
        .doc = "One use of an effect.",
        .keys = {
            required("effect",
                     text({.fault = "'effect' is empty: it is the id of an effect", .min_length = 1}),
                     "Id of the effect, or the path of an ISF file from the look's folder "
                     "([ISF](isf.md)); a second step of the same effect needs a `name`."),
            optional("space", grammar::choice({"display", "linear"}),
                     "The image that an ISF file works on: encoded `display` or scene-linear `color`.",
                     "\"display\""),
            optional("name", step_name(), "Name of the step; default: the effect's id."),
            optional("enabled", grammar::boolean(), "false skips the step, but still checks it.", "true"),
            optional("preset", text(), "Preset of the effect."),
            optional("params", any_object("[value](#values)"), "Values, which override the preset's."),
            optional("in", grammar::map(look_wire(), {.by = "input"}),
                     "Sources of inputs; default: the nearest earlier step that outputs the role, else the "
                     "capture ([wiring](#wiring))."),
            optional("mix", grammar::custom({.type = "[value](#values), 0 to 1"}),
                     "Blend from the image before the step to its result."),
            optional("mask", grammar::with_variables(grammar::object(look_mask_block())),
                     "Where the step applies.")}};
    return block;
}

const Block& look_use_block() {
    static const Block block{
        .name = "use",
        .thing = "the step",
        .doc = "The steps of another look.",
        .keys = {required("use", text(), "File of the other look, relative to this one."),
                 optional("name", grammar::snake_case(), "Prefix of its steps' names: `base_...`."),
                 optional("enabled", grammar::boolean(), "false skips all its steps.", "true"),
                 optional("vars", any_object("[value](#values)"),
                          "Values of variables, which override its own.")}};
    return block;
}

const Block& look_block() {
    static const Block block{
        .name = "look",
        .thing = "the look",
        .doc = "The document.",
        .keys = {optional("summary", text(), "One sentence."),
                 optional("vars",
                          grammar::named(grammar::custom({.type = "[value](#values)"}), "the variable"),
                          "Values by name, for {\"var\": \"name\"}."),
                 required("steps", grammar::list(grammar::custom({.type = "step"})), "Steps, in order.")},
        .is_document = true};
    return block;
}

}  // namespace aftershade
