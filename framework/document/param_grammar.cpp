#include "framework/document/param_grammar.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "framework/base/text.h"
#include "framework/document/grammar_form.h"
#include "framework/document/param_type.h"
#include "framework/document/units.h"

namespace aftershade {

using grammar::Block;
using grammar::Form;
using grammar::Key;
using grammar::optional;
using grammar::required;

namespace {

/// A value of the type, in any unit and any range: the declaration's own are not known to the grammar.
class AnyValue : public grammar::FormType {
public:
    explicit AnyValue(ParamType type) : type_(type) {}

    bool takes(Node::Kind) const override { return true; }
    void check(const Node&, const grammar::Spot&, Diagnostics&) const override {}
    schema::json schema(grammar::SchemaScope&) const override {
        ParamSpec any;
        any.type = type_;
        any.domain = {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
        if (type_->has_range) any.unit = schema::kAnyUnit;
        return schema::literal(any);
    }
    grammar::Words words() const override {
        return {.type = "[value](#types)", .noun = "a value", .nouns = "values"};
    }

private:
    ParamType type_;
};

/// "a bool", "an enum", for messages.
std::string a_type(ParamType type) {
    if (!type->phrase.empty()) return std::string(type->phrase);
    const std::string name(type->name);
    return (std::string_view("aeiou").find(name[0]) == std::string_view::npos ? "a " : "an ") + name;
}

Form bind_form(ParamType type) {
    if (is_block_type(type)) return grammar::choice({"uniform", "define"});
    return grammar::choice({"uniform"},
                           {.words = {"define"},
                            .fault = a_type(type) + " cannot be a define: it reaches a shader as a "
                                                    "texture or a buffer"});
}

Form requires_form() {
    return grammar::list(grammar::text(
        {.pattern = {R"(^\s*(<|<=|>|>=)\s*[a-z][a-z0-9_]*\s*$)",
                     [](const std::string& text) { return parse_relation(text, {}).has_value(); }},
         .fault = "'{}' is not a relation; write '<', '<=', '>' or '>=' and the name of a "
                  "parameter: \"> focal_length\"",
         .type = "[relation](#relations)"}));
}

/// Of numbers.
std::vector<Key> range_keys() {
    constexpr const char* kEnds = "'ui' holds two numbers, the ends of a slider";
    return {optional("unit", grammar::shown_as(grammar::choice(unit_names()), "unit"),
                     "Unit that GLSL receives: " + joined(unit_names(), " or ") +
                         "; default: none, for an angle `deg`."),
            optional("min", grammar::number(), "Limits of each component, or of a curve's y."),
            optional("max", grammar::number(), "Likewise."),
            optional("ui", grammar::list(grammar::number(), {.min = 2, .max = 2, .fault = kEnds}),
                     "Ends of a slider, within the limits.")};
}

/// Of a parameter that is no column.
std::vector<Key> manifest_keys(ParamType type, const ParamSources& sources) {
    std::vector<Key> keys = {
        optional("bind", bind_form(type), "`define`: one program per value used.", "\"uniform\""),
        optional("identity", grammar::make_form<AnyValue>(type), "The value that leaves the image as it is."),
        optional(
            "section", grammar::text({.min_length = 1}),
            "Heading for parameters that belong together, in words: `Aperture`; default: none, and first."),
        optional("advanced", grammar::boolean(), "Last and folded away on the page: few looks need it.",
                 "false")};
    if (is_block_type(type))
        keys.push_back(
            optional("from",
                     grammar::shown_as(sources ? grammar::name_of(sources(type), "a value of the capture")
                                               : grammar::text(),
                                       "`camera.<field>`"),
                     "The default where the capture has that value."));
    if (type->is_scalar)
        keys.push_back(optional("requires", requires_form(), "Relation to other parameters."));
    return keys;
}

/// What the declaration of every type, and of this one, has; `column` is that of a table's columns.
Block declaration_of(ParamType type, const Block& column) {
    Block block{.name = std::string(type->name)};
    Key value = optional("default", grammar::make_form<AnyValue>(type), "The value when none is set.");
    value.required = type->has_default;
    block.keys.push_back(std::move(value));
    if (type->has_range)
        for (Key& key : range_keys()) block.keys.push_back(std::move(key));
    type->declare(block, column);
    return block;
}

/// Of parameters or of columns.
Block block_of(const std::string& name, std::string doc) {
    return {.name = name,
            .thing = name + " '{}'",
            .doc = std::move(doc),
            .keys = {required("doc", grammar::text(), "One sentence.")},
            .selector = "type",
            .definition = name};
}

/// Of a table: of a block type, a uniform, and without a relation to anything else.
Block column_block(std::span<const ParamType> types) {
    Block block = block_of("column", "A column of a table, with a value per object.");
    block.name.clear();
    block.type = "[column](#tables)";
    for (const ParamType type : types)
        if (is_block_type(type)) block.kinds.push_back(declaration_of(type, {}));
    return block;
}

}  // namespace

Block param_block(std::span<const ParamType> types, const ParamSources& sources) {
    const Block column = column_block(types);
    Block block = block_of("parameter", "A value that users set.");
    for (const ParamType type : types) {
        Block kind = declaration_of(type, column);
        for (Key& key : manifest_keys(type, sources)) kind.keys.push_back(std::move(key));
        block.kinds.push_back(std::move(kind));
    }
    return block;
}

std::optional<ParamRelation> parse_relation(std::string_view text, const Place& place) {
    using Order = ParamRelation::Order;
    constexpr std::string_view kSpace = " \t\n\v\f\r";
    const auto trim = [&] {
        text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
        text = text.substr(0, text.find_last_not_of(kSpace) + 1);
    };
    trim();
    if (!text.starts_with('<') && !text.starts_with('>')) return std::nullopt;
    const bool is_less = text.starts_with('<');
    text.remove_prefix(1);
    const bool is_equal = text.starts_with('=');
    if (is_equal) text.remove_prefix(1);
    trim();
    if (!is_snake_case(text)) return std::nullopt;
    const Order order = is_less ? (is_equal ? Order::less_equal : Order::less)
                                : (is_equal ? Order::greater_equal : Order::greater);
    return ParamRelation{order, std::string(text), place};
}

}  // namespace aftershade
