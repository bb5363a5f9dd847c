#include "framework/effect/manifest/manifest_grammar.h"

#include <algorithm>

#include "framework/base/option.h"
#include "framework/base/text.h"
#include "framework/document/grammar_schema.h"
#include "framework/document/param_grammar.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/units.h"
#include "framework/effect/manifest/manifest_blocks.h"
#include "framework/effect/manifest/manifest_groups.h"
#include "framework/effect/param_types.h"
#include "framework/image/camera.h"
#include "framework/image/image_forms.h"

namespace aftershade {

using grammar::Block;
using grammar::boolean;
using grammar::choice;
using grammar::Form;
using grammar::integer;
using grammar::Key;
using grammar::number;
using grammar::optional;
using grammar::required;
using grammar::text;
using grammar::when;

namespace {

constexpr int kMaxTableSide = 1024;

/// "1.0.0": three numbers without leading zeros.
bool is_version(std::string_view text) {
    for (int part = 0; part < 3; ++part) {
        const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
        if (digits == 0 || (digits > 1 && text[0] == '0')) return false;
        text.remove_prefix(digits);
        if (part == 2) return text.empty();
        if (!text.starts_with('.')) return false;
        text.remove_prefix(1);
    }
    return false;
}

Form version_form() {
    return text({.pattern = {R"(^(0|[1-9][0-9]*)\.(0|[1-9][0-9]*)\.(0|[1-9][0-9]*)$)", is_version},
                 .fault = "'version' is '{}' but must be MAJOR.MINOR.PATCH, such as 1.0.0",
                 .type = "`MAJOR.MINOR.PATCH`"});
}

Block make_input_block() {
    constexpr const char* kLayersEnd =
        "an input of a layer must be 'optional': a capture may have fewer layers";
    constexpr int kMostInputLayer = 7;
    constexpr const char* kShotsEnd = "an input of another frame must be 'optional': shots begin and end";
    std::vector<Form> offsets;
    for (int distance = 1; distance <= kMostFrameOffset; ++distance)
        for (const int offset : {-distance, distance})
            offsets.push_back(grammar::constant(std::to_string(offset)));
    const std::string most = std::to_string(kMostFrameOffset);
    const Form frame =
        grammar::shown_as(grammar::any_of(std::move(offsets), "'frame' is -" + most + " to -1 or 1 to " +
                                                                  most + ": a capture before or after"),
                          "`-" + most + "` to `-1`, `1` to `" + most + "`");
    const auto is_optional = std::pair<std::string, Form>{"optional", grammar::constant("true")};
    return {
        .name = "input",
        .thing = "input '{}'",
        .doc = "An image that the effect reads.",
        .keys =
            {required(
                 "role", step_role_form(),
                 "`aov:<name>` takes any image of floats that a look wires to it, an earlier step's texture "
                 "too, in its own size: read `name_size`."),
             optional("optional", boolean(),
                      "The input may be missing; the shader has `HAS_<NAME>` if the image is there.",
                      "false"),
             optional("history", boolean(), "Passes may read the previous frame's image as `name.prev`.",
                      "false"),
             optional("frame", frame,
                      "Take a capture before (negative) or after this one instead; such an input must be "
                      "`optional`."),
             optional("layer", grammar::integer(0, kMostInputLayer),
                      "The image of one layer of the capture, 0 in front; such an input is `optional`: the "
                      "capture "
                      "may have fewer. The last layer that a look reads holds all that lies behind it."),
             optional("from", choice({"capture"}),
                      "Take the capture's own image even if an earlier step outputs that role, unless the "
                      "look's `in` says otherwise."),
             optional("instead", text(), "Another optional input: a capture must have one of the two."),
             input_when_key(
                 "For optional inputs: if they do not hold, the input is absent and its image is not read."),
             optional("doc", text(), "One sentence.")},
        .rules = {
            when({.key = "frame", .required = {"optional"}, .narrowed = {is_optional}, .fault = kShotsEnd}),
            when({.key = "frame",
                  .narrowed = {{"history", grammar::constant("false")}},
                  .fault = "an input has 'frame' or 'history', not both"}),
            when(
                {.key = "frame",
                 .absent = {"from"},
                 .fault = "an input has 'frame' or 'from', not both: other frames are the capture's anyway"}),
            when({.key = "layer", .required = {"optional"}, .narrowed = {is_optional}, .fault = kLayersEnd}),
            when({.key = "layer",
                  .absent = {"frame", "from"},
                  .narrowed = {{"history", grammar::constant("false")}},
                  .fault =
                      "an input has 'layer' or one of 'history', 'frame' and 'from', not both: layers are "
                      "those of the capture's own frame"}),
            when({.key = "instead",
                  .required = {"optional"},
                  .narrowed = {is_optional},
                  .fault = "an input with 'instead' must be 'optional': one without it is always there"}),
            when({.key = "when",
                  .required = {"optional"},
                  .narrowed = {is_optional},
                  .fault = "an input with 'when' must be 'optional'"})}};
}

Block output_block() {
    return {.name = "output",
            .thing = "output '{}'",
            .doc = "An image that the effect outputs; a pass must write it.",
            .keys = {required("role", step_role_form(), "Role of the image."),
                     optional("doc", text(), "One sentence.")}};
}

Block uniform_block() {
    return {.name = "uniform",
            .thing = "native uniform '{}'",
            .doc = "A value that native code sets.",
            .keys = {required("type", choice({"float", "int", "uint", "vec2", "vec3", "vec4"}), "GLSL type."),
                     required("doc", text(), "One sentence.")}};
}

Block native_table_block() {
    const Form side = integer(1, kMaxTableSide);
    const Form sides = grammar::any_of(
        {side, grammar::list(side, {.min = 2, .max = 2, .fault = "'count' holds 2 integers"})});
    return {
        .name = "table",
        .thing = "native table '{}'",
        .doc = "An array that native code fills.",
        .keys = {
            required("element", choice({"float", "vec2", "vec4", "uint", "uvec2", "uvec4"}), "GLSL type."),
            required("count",
                     grammar::shown_as(sides, "int, or [int, int], up to " + std::to_string(kMaxTableSide)),
                     "Largest number of elements per row, and of rows."),
            required("doc", text(), "One sentence.")}};
}

Block native_block() {
    return {.name = "native",
            .doc = "Values that the effect's native code sets before each frame.",
            .keys = {optional("uniforms", grammar::named(grammar::object(uniform_block()), "native uniform"),
                              "`native.<name>` in GLSL."),
                     optional("tables", grammar::named(grammar::object(native_table_block()), "native table"),
                              "Read by `texelFetch(name, ivec2(i, row), 0)`.")}};
}

/// [from, to, count]
Form bins_form() {
    const auto check = [](const Node& node, const grammar::Spot&, Diagnostics& diagnostics) {
        const auto is_number = [](const Node& item) { return item.is_number(); };
        if (node.items.size() != 3 || !std::all_of(node.items.begin(), node.items.end(), is_number)) {
            diagnostics.error(node.place, "'bins' is [from, to, count], three numbers: [0, 64, 8]");
            return;
        }
        if (node.items[0].number >= node.items[1].number)
            diagnostics.error(node.place, "'bins' must go up: its second number is not above its first");
        const double count = node.items[2].number;
        if (count < 1 || count > kMaxBins || count != double(int(count)))
            diagnostics.error(node.items[2].place, "'bins' has " + format_number(count) +
                                                       " bins, but an integer from 1 to " +
                                                       std::to_string(kMaxBins) + " is needed");
    };
    return grammar::custom(
        {.type = "[from, to, count], up to " + std::to_string(kMaxBins),
         .schema = R"({"type": "array", "minItems": 3, "maxItems": 3, "prefixItems": [{"type": "number"},
             {"type": "number"}, {"type": "integer", "minimum": 1, "maximum": )" +
                   std::to_string(kMaxBins) + "}]}",
         .check = check});
}

Block statistic_block() {
    return {
        .name = "statistic",
        .thing = "statistic '{}'",
        .doc = "A number of each frame for `" + spelled(Option::telemetry) +
               "`. A pass whose textures only telemetry or a tap needs "
               "does not run otherwise.",
        .keys = {
            required("of", channel_form(), "Channel to summarise: count, sum, mean, deviation, extremes."),
            optional("where", channel_form(),
                     "Count only texels where this channel, of a texture of the same size, is above 0."),
            optional("squared", boolean(), "Square the values: a deviation becomes a variance.", "false"),
            optional("bins", bins_form(),
                     "Bins of a histogram; values outside go into the first and the last."),
            optional("doc", text(), "One sentence, with the unit.")}};
}

bool any_name(const std::string&) {
    return true;
}

/// The parser checks names and values, which the parameters declare.
Block preset_block() {
    return {.name = "",
            .thing = "preset '{}'",
            .others = {{{"^", any_name}, grammar::custom({.type = "value"})}},
            .type = "values by parameter"};
}

Form uses_form() {
    return grammar::list(grammar::name_of({"lights"}, "a block that shaders can use"), {.unique = true});
}

/// What effects and modules both declare.
std::vector<Key> shared_keys() {
    return {optional("uses", uses_form(), "`[\"lights\"]` gives shaders the block [`lights`](#shaders)."),
            optional("params",
                     grammar::shown_as(grammar::named(grammar::object(manifest_param_block), "parameter"),
                                       "[parameter](params.md) by name"),
                     "Parameters that users set."),
            optional("textures", section_form("textures"), "Images between passes."),
            optional("buffers", section_form("buffers"), "Arrays."),
            optional("tiles", section_form("tiles"), "Lists of tiles that confine draws.")};
}

Block warmup_block() {
    return {.name = "warmup",
            .thing = "'warmup'",
            .doc =
                "Frames that a chunk of a sequence renders first, without writing them, because it starts "
                "without history. `aftershade check LOOK " +
                spelled(Option::warmup, "CAPTURE") + "` measures both numbers.",
            .keys = {required("frames", integer(0, kMaxWarmupFrames), "Number of frames to render first."),
                     required("error", number({.min = 0}),
                              "Remaining difference from an uncut run: the 99th percentile over the picture, "
                              "relative to its mean.")}};
}

Form reach_form() {
    constexpr const char* kFault = "'reach' is a number of px, \"all\", or a list of numbers and parameters";
    const Form px = integer(0, kMaxReachPx);
    const Form part = grammar::by_kind(
        {px, reference_form(R"(^([1-9][0-9]? \* )?[a-z][a-z0-9_]*$)", "name, or `10 * name`")},
        "a part of 'reach' is a number of px or the name of a parameter");
    return grammar::by_kind({px, choice({"all"}), grammar::list(part, {.min = 1})}, kFault);
}

Block make_effect_block() {
    // The parser reports a module that does not exist.
    const Form module = reference_form(schema::kSnakeCase, "name");
    Block block{
        .name = "effect",
        .thing = "the manifest",
        .doc = "The document.",
        .keys = {required("id", identifier_form("the id"), "The name of its folder."),
                 required("version", version_form(), "Version of the effect."),
                 required("summary", text(), "One sentence."),
                 optional("group", choice(effect_groups()), "Its place in lists of effects."),
                 optional("recommended", grammar::boolean(),
                          "Comes first in its group, as the effect that most looks need.", "false"),
                 optional("sources", grammar::list(text()), "Papers and pages that the effect follows."),
                 optional("accumulates", choice({"subframes"}),
                          "Run the effect once per sub-frame; the last one outputs the result."),
                 optional("warmup", grammar::object(warmup_block()),
                          "How fast the effect recovers from missing history: [below](#warmup)."),
                 optional("reach", reach_form(),
                          "How far around a pixel its result depends on the inputs: [below](#reach)."),
                 optional(
                     "window", choice({"data", "display"}),
                     "The pixels that the effect works on: all that the capture has, or the display window. "
                     "Its outputs are 0 outside.",
                     "\"data\""),
                 optional("modules", grammar::list(module, {.unique = true}),
                          "Modules whose declarations come before the effect's own: [below](#modules)."),
                 required("inputs", section_form("inputs"), "Images that the effect reads."),
                 required("outputs",
                          grammar::map(grammar::object(output_block()),
                                       {.pattern = grammar::snake_case_pattern(),
                                        .fault = std::string("output '{}' ") + kMustBeSnakeCase,
                                        .min = 1,
                                        .count_fault = "the effect has no outputs"}),
                          "Images that the effect outputs.")},
        .is_document = true};
    for (Key& key : shared_keys()) block.keys.push_back(std::move(key));
    block.keys.push_back(
        required("passes", section_form("passes", "the effect has no passes"), "Passes in order."));
    block.keys.push_back(optional("native", grammar::object(native_block()), "Values of native code."));
    block.keys.push_back(optional("telemetry",
                                  grammar::named(grammar::object(statistic_block()), "statistic"),
                                  "Statistics of each frame."));
    block.keys.push_back(
        optional("presets", grammar::map(grammar::object(preset_block())), "Named sets of values."));
    return block;
}

Block make_module_block() {
    Block block{
        .name = "module",
        .thing = "the module",
        .doc = "The document.",
        .keys =
            {required("module", identifier_form("the module"), "The name of its folder."),
             required("summary", text(), "One sentence."),
             optional(
                 "before", grammar::list(reference_form(schema::kSnakeCase, "name"), {.unique = true}),
                 "Modules whose effects belong after this one's in a look; the other order is a warning.")},
        .is_document = true};
    for (Key& key : shared_keys()) block.keys.push_back(std::move(key));
    block.keys.push_back(optional("passes", section_form("passes"), "Passes in order."));
    return block;
}

}  // namespace

const Block& manifest_param_block() {
    static const Block block = param_block(param_types(), camera_sources);
    return block;
}

const Block& input_block() {
    static const Block block = make_input_block();
    return block;
}

const Block& effect_block() {
    static const Block block = make_effect_block();
    return block;
}

const Block& module_block() {
    static const Block block = make_module_block();
    return block;
}

std::string effect_schema() {
    return grammar::schema_text("Aftershade effect", effect_block());
}

std::string module_schema() {
    return grammar::schema_text("Aftershade module", module_block());
}

}  // namespace aftershade
