// The grammar of groups and `for`.
#include <algorithm>
#include <utility>

#include "framework/document/grammar_form.h"
#include "framework/effect/manifest/manifest_blocks.h"
#include "framework/effect/manifest/manifest_grammar.h"
#include "framework/effect/manifest/manifest_groups.h"

namespace aftershade {

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
