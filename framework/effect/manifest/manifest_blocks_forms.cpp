// Forms of values that several sections of a manifest have.
#include <algorithm>
#include <cctype>
#include <utility>

#include "framework/base/text.h"
#include "framework/document/schema_pieces.h"
#include "framework/effect/manifest/manifest_blocks.h"
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

}  // namespace aftershade
