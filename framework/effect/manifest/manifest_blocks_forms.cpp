// Forms of values that several sections of a manifest have; the grammar of groups and `for`.
#include <algorithm>
#include <cctype>
#include <utility>

#include "framework/base/text.h"
#include "framework/document/grammar_form.h"
#include "framework/document/schema_pieces.h"
#include "framework/effect/manifest/manifest_blocks.h"
#include "framework/effect/manifest/manifest_grammar.h"
#include "framework/effect/manifest/manifest_groups.h"
#include "framework/effect/manifest/manifest_when.h"

namespace aftershade {

using grammar::Block;
using grammar::Form;
using grammar::Key;
using grammar::optional;
using grammar::text;

namespace {

/// GL_MAX_SHADER_STORAGE_BLOCK_SIZE of llvmpipe, and the least of OpenGL 4.5.
constexpr std::int64_t kMaxBufferBytes = std::int64_t(128) << 20;

constexpr const char* kPerFault = R"('per' is "pixel", {"tile": 16} or {"scale": 0.5})";

/// One value, or several of which one must be there.
Form one_or_more(const Form& value, const std::string& fault) {
    return grammar::by_kind(
        {value, grammar::list(value, {.min = 1, .fault = "a condition without a value never holds"})}, fault);
}

Form condition_on_input() {
    return one_or_more(grammar::boolean(), "a condition on an input compares with true or false");
}

Form condition_on_number() {
    return one_or_more(grammar::boolean(), "whether a number is not 0 compares with true or false");
}

Form condition_on_change() {
    return one_or_more(grammar::boolean(),
                       "whether a parameter changes the image compares with true or false");
}

Form condition_on_param() {
    constexpr const char* kFault = "a condition compares with true, false, an integer or a name";
    const Form value = grammar::by_kind({grammar::boolean(), grammar::integer(), text()}, kFault);
    return one_or_more(value, kFault);
}

grammar::Pattern on_input() {
    return {R"(^has\.)", [](const std::string& name) { return name.starts_with(kHasInput); }};
}

grammar::Pattern on_number() {
    return {R"(^nonzero\.)", [](const std::string& name) { return name.starts_with(kNonzero); }};
}

grammar::Pattern on_change() {
    return {R"(^changes\.)", [](const std::string& name) { return name.starts_with(kChanges); }};
}

grammar::Pattern on_param() {
    return {R"(^(?!has\.|nonzero\.|changes\.))",
            [](const std::string& name) { return name_in_condition(name) == name; }};
}

Block conditions_block() {
    return {.name = "",
            .others = {{on_input(), condition_on_input()},
                       {on_number(), condition_on_number()},
                       {on_change(), condition_on_change()},
                       {on_param(), condition_on_param()}},
            .type = "[conditions](#conditions)"};
}

Block conditions_of_input_block() {
    return {.name = "",
            .others = {{on_param(), condition_on_param()}},
            .unknown_key =
                "only passes test whether an input is present, a number is not 0 or a parameter changes the "
                "image; the conditions of an input are on values of parameters",
            .type = "[conditions](#conditions) on parameters"};
}

Block per_block() {
    return {.name = "",
            .keys = {optional("tile", count_form(kTileCount), ""), optional("scale", grid_scale_form(), "")},
            .rules = {grammar::exactly_one_of({"tile", "scale"})},
            .type = R"(`{"tile": n}` or `{"scale": x}`)"};
}

}  // namespace

int components_of(const std::string& element) {
    return std::isdigit(static_cast<unsigned char>(element.back())) ? element.back() - '0' : 1;
}

CountLimits element_count(const std::string& element) {
    return {1, kMaxBufferBytes / 4 / components_of(element)};
}

Form identifier_form(const std::string& thing) {
    return text({.pattern = grammar::snake_case_pattern(),
                 .fault = thing + " '{}' " + kMustBeSnakeCase,
                 .type = "name"});
}

Form reference_form(const std::string& pattern, const std::string& type) {
    return text({.pattern = {pattern, [](const std::string&) { return true; }}, .type = type});
}

Form count_form(const CountLimits& limits) {
    return grammar::any_of(
        {grammar::integer(limits.least, limits.most), text({.pattern = grammar::snake_case_pattern(),
                                                            .type = "[count](#counts)",
                                                            .noun = "the name of an int parameter"})});
}

Form texel_form() {
    const auto check = [](const Node& node, const grammar::Spot& spot, Diagnostics& diagnostics) {
        const auto is_number = [](const Node& item) { return item.is_number(); };
        const std::size_t count = node.items.size();
        if (node.is_number()) return;
        if (count == 0 || !std::all_of(node.items.begin(), node.items.end(), is_number))
            diagnostics.error(node.place, "'" + spot.key + "' must be a number or an array of numbers");
        else if (count != 1 && count != 4)
            diagnostics.error(node.place,
                              "'" + spot.key + "' is one number or four, not " + std::to_string(count));
    };
    return grammar::custom({.type = "number, or list of 4",
                            .schema = R"({"anyOf": [{"type": "number"},
                                {"type": "array", "items": {"type": "number"}, "minItems": 1, "maxItems": 1},
                                {"type": "array", "items": {"type": "number"}, "minItems": 4, "maxItems": 4}]})",
                            .check = check});
}

Form channel_form() {
    return reference_form(R"(^[a-z][a-z0-9_]*\.[rgba]$)", "`texture.r`, `.g`, `.b` or `.a`");
}

Form grid_scale_form() {
    return grammar::number({.above = 0, .max = 4});
}

Form per_form() {
    return grammar::by_kind(
        {grammar::with_fault(grammar::constant("\"pixel\""), kPerFault), grammar::object(per_block())},
        kPerFault);
}

Key when_key(std::string doc, bool is_required) {
    Key key = optional("when", grammar::object(conditions_block()), std::move(doc));
    key.required = is_required;
    return key;
}

Key input_when_key(std::string doc) {
    return optional("when", grammar::object(conditions_of_input_block()), std::move(doc));
}

using grammar::Block;
using grammar::Form;
using grammar::Key;
using grammar::list;
using grammar::object;

namespace {

/// A name that may hold variables.
Form named_in_braces(Form value) {
    return grammar::map(std::move(value), {.pattern = {R"(^([a-z]|\{[^{}]+\})([a-z0-9_]|\{[^{}]+\})*$)"}});
}

Form in_braces(Form form) {
    return grammar::with_variables(std::move(form), schema::Variables::in_braces);
}

Form for_form() {
    const Form values =
        list(grammar::any_of({grammar::number(), grammar::text()}), {.min = 1, .max = kMaxTurns});
    const Form range = grammar::text(
        {.pattern = {R"(^ *(?=[-0-9]{1,6} *\.)-?[0-9]+ *\.\. *(?=[-0-9]{1,6} *$)-?[0-9]+ *$)"}});
    return grammar::shown_as(
        grammar::map(grammar::any_of({range, values}), {.pattern = grammar::snake_case_pattern(), .min = 1}),
        "`\"1..8\"`, or list of (text, or number), by variable");
}

Block group_of(const GroupedSection& section) {
    const Form inside = object(section.group);
    const Form entries = section.name == "passes"
                             ? list(grammar::any_of({in_braces(grammar::snake_case()), inside}), {.min = 1})
                             : named_in_braces(inside);
    Block group{
        .name = "group",
        .thing = "the group",
        .doc = "Entries that share keys, or one entry for several.",
        .keys = {grammar::optional("for", for_form(),
                                   "Write out the group, or the entry, for each value of a variable."),
                 grammar::optional(section.name, grammar::shown_as(entries, "entries, and groups of them"),
                                   "Entries of a group of textures; in other sections `inputs`, `buffers`, "
                                   "`tiles` or `passes`.")},
        .definition = "group_of_" + section.name};
    const Block& entry = section.entry();
    const auto add = [&](Key key) {
        if (std::ranges::any_of(group.keys, [&](const Key& other) { return other.name == key.name; })) return;
        group.keys.push_back(grammar::optional(key.name, in_braces(std::move(key.form)), std::move(key.doc)));
        group.keys.back().has_row = false;
    };
    if (!entry.selector.empty()) add(selector_key(entry));
    for (const Key& key : entry.keys) add(key);
    for (const Block& kind : entry.kinds)
        for (const Key& key : kind.keys) add(key);
    return group;
}

enum Section { kInputs, kTextures, kBuffers, kTiles, kPasses };

template <Section section>
const Block& group() {
    static const Block block = group_of(grouped_sections()[section]);
    return block;
}

}  // namespace

const std::vector<GroupedSection>& grouped_sections() {
    static const std::vector<GroupedSection> all{{"inputs", "input", input_block, group<kInputs>},
                                                 {"textures", "texture", texture_block, group<kTextures>},
                                                 {"buffers", "buffer", buffer_block, group<kBuffers>},
                                                 {"tiles", "tile list", tile_list_block, group<kTiles>},
                                                 {"passes", "pass", pass_block, group<kPasses>}};
    return all;
}

const Block& group_block() {
    return group<kTextures>();
}

Form section_form(const std::string& name, const std::string& fault_of_none) {
    const auto is_it = [&](const GroupedSection& section) { return section.name == name; };
    const GroupedSection& section = *std::ranges::find_if(grouped_sections(), is_it);
    const Form entry = object(section.entry), group = object(section.group);
    const Form written = grammar::by_key("for", group, grammar::by_key(name, group, entry));
    const std::string& block = section.entry().name;
    const std::string shown = "[" + block + "](#" + block + "), or [group](#group)";
    if (name != "passes")
        return grammar::written_as(grammar::named(entry, section.thing),
                                   named_in_braces(grammar::shown_as(written, shown)));
    const grammar::ListLimits limits{.min = fault_of_none.empty() ? 0 : 1, .fault = fault_of_none};
    return grammar::written_as(
        list(entry, limits),
        list(grammar::shown_as(grammar::any_of({grammar::snake_case(), written}), "name, or " + shown),
             limits));
}

}  // namespace aftershade
