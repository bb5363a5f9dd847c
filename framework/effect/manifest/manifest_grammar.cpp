#include "framework/effect/manifest/manifest_grammar.h"

#include <algorithm>

#include "framework/core/grammar_schema.h"
#include "framework/core/param_grammar.h"
#include "framework/core/schema_pieces.h"
#include "framework/core/text.h"
#include "framework/core/units.h"
#include "framework/effect/manifest/manifest_blocks.h"
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

Block input_block() {
    constexpr const char* kShotsEnd = "an input of another frame must be 'optional': shots begin and end";
    const Form frame = grammar::shown_as(grammar::any_of({grammar::constant("-1"), grammar::constant("1")},
                                                         "'frame' is -1 or 1: the capture before or after"),
                                         "`-1` or `1`");
    const auto is_optional = std::pair<std::string, Form>{"optional", grammar::constant("true")};
    return {
        .name = "input",
        .thing = "input '{}'",
        .doc = "An image that the effect takes.",
        .keys =
            {required(
                 "role", role_form(),
                 "`aov:<name>` takes any image of floats that a look wires to it, an earlier step's texture "
                 "too, in its own size: ask `name_size`."),
             optional("optional", boolean(), "The shader has `HAS_<NAME>` where the image is there.",
                      "false"),
             optional("history", boolean(), "Last frame's image may be read as `name.prev`.", "false"),
             optional("frame", frame, "The capture before or after; such an input is `optional`."),
             optional("from", choice({"capture"}),
                      "The capture's own image even where an earlier step makes that role, unless the look's "
                      "`in` says otherwise."),
             input_when_key(
                 "Of optional inputs: without them the input is absent and its image is not read."),
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
            when({.key = "when",
                  .required = {"optional"},
                  .narrowed = {is_optional},
                  .fault = "an input with 'when' must be 'optional'"})}};
}

Block output_block() {
    return {.name = "output",
            .thing = "output '{}'",
            .doc = "An image that the effect makes; a pass must write it.",
            .keys = {required("role", role_form(), "What it is."), optional("doc", text(), "One sentence.")}};
}

Block uniform_block() {
    return {.name = "uniform",
            .thing = "native uniform '{}'",
            .doc = "A value of native code.",
            .keys = {required("type", choice({"float", "int", "uint", "vec2", "vec3", "vec4"}), "In GLSL."),
                     required("doc", text(), "One sentence.")}};
}

Block native_table_block() {
    const Form side = integer(1, kMaxTableSide);
    const Form sides = grammar::any_of(
        {side, grammar::list(side, {.min = 2, .max = 2, .fault = "'count' holds 2 integers"})});
    return {
        .name = "table",
        .thing = "native table '{}'",
        .doc = "An array of native code.",
        .keys = {
            required("element", choice({"float", "vec2", "vec4", "uint", "uvec2", "uvec4"}), "In GLSL."),
            required("count",
                     grammar::shown_as(sides, "int, or [int, int], up to " + std::to_string(kMaxTableSide)),
                     "Most elements of a row, and how many rows."),
            required("doc", text(), "One sentence.")}};
}

Block native_block() {
    return {.name = "native",
            .doc = "What the effect's native code fills before each frame.",
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
        .doc =
            "A number of each frame for `--telemetry`. A pass whose textures only telemetry or a tap needs "
            "does not run otherwise.",
        .keys = {
            required("of", channel_form(),
                     "Its texels are summed up: count, sum, mean, deviation, extremes."),
            optional("where", channel_form(),
                     "Only the texels where this is above 0, of a texture of the same size."),
            optional("squared", boolean(), "Its square: of a deviation the variance.", "false"),
            optional("bins", bins_form(), "Of a histogram; what lies outside goes to the first and last."),
            optional("doc", text(), "One sentence with the unit.")}};
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
    return {optional("uses", uses_form(), "`[\"lights\"]`: shaders have the block [`lights`](#shaders)."),
            optional("params",
                     grammar::shown_as(grammar::named(grammar::object(manifest_param_block), "parameter"),
                                       "[parameter](params.md) by name"),
                     "What users set."),
            optional("textures", grammar::named(grammar::object(texture_block), "texture"),
                     "Images between passes."),
            optional("buffers", grammar::named(grammar::object(buffer_block), "buffer"), "Arrays."),
            optional("tiles", grammar::named(grammar::object(tile_list_block), "tile list"),
                     "Lists of tiles that draws are confined to.")};
}

Block warmup_block() {
    return {
        .name = "warmup",
        .thing = "'warmup'",
        .doc =
            "A chunk of a sequence that begins without history renders some frames that it does not write. "
            "`aftershade check LOOK --warmup CAPTURE` measures both numbers.",
        .keys = {required("frames", integer(0, kMaxWarmupFrames),
                          "Frames rendered before the first one that counts."),
                 required("error", number({.min = 0}),
                          "Difference from an uncut run that remains then: the 99th percentile over the "
                          "picture, as a share of its mean.")}};
}

Block make_effect_block() {
    // The parser reports a module that does not exist.
    const Form module = reference_form(schema::kSnakeCase, "name");
    Block block{.name = "effect",
                .thing = "the manifest",
                .doc = "The document.",
                .keys = {required("id", identifier_form("the id"), "The name of its folder."),
                         required("version", version_form(), "Of the effect."),
                         required("summary", text(), "One sentence."),
                         optional("sources", grammar::list(text()), "Papers and pages that it follows."),
                         optional("accumulates", choice({"subframes"}),
                                  "The effect runs once for each subframe and emits at the last."),
                         optional("warmup", grammar::object(warmup_block()),
                                  "How soon the effect forgets that its history began: [below](#warmup)."),
                         optional("modules", grammar::list(module, {.unique = true}),
                                  "Their declarations stand before the effect's own: [below](#modules)."),
                         required("inputs", grammar::named(grammar::object(input_block()), "input"),
                                  "Images that it takes."),
                         required("outputs",
                                  grammar::map(grammar::object(output_block()),
                                               {.pattern = grammar::snake_case_pattern(),
                                                .fault = std::string("output '{}' ") + kMustBeSnakeCase,
                                                .min = 1,
                                                .count_fault = "the effect has no outputs"}),
                                  "Images that it makes.")},
                .is_document = true};
    for (Key& key : shared_keys()) block.keys.push_back(std::move(key));
    block.keys.push_back(required("passes", passes_form("the effect has no passes"), "In their order."));
    block.keys.push_back(optional("native", grammar::object(native_block()), "Values of native code."));
    block.keys.push_back(optional("telemetry",
                                  grammar::named(grammar::object(statistic_block()), "statistic"),
                                  "Numbers of each frame."));
    block.keys.push_back(
        optional("presets", grammar::map(grammar::object(preset_block())), "Values to choose by one name."));
    return block;
}

Block make_module_block() {
    Block block{.name = "module",
                .thing = "the module",
                .doc = "The document.",
                .keys = {required("module", identifier_form("the module"), "The name of its folder."),
                         required("summary", text(), "One sentence.")},
                .is_document = true};
    for (Key& key : shared_keys()) block.keys.push_back(std::move(key));
    block.keys.push_back(optional("passes", passes_form(), "In their order."));
    return block;
}

}  // namespace

const Block& manifest_param_block() {
    static const Block block = param_block(param_types(), camera_sources);
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
