// One of a few names.
#include <algorithm>

#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"

namespace aftershade {

namespace enum_type {

/// Shaders see a value as a preprocessor symbol: SHAPE_HEXAGON.
bool is_value(const std::string& name) {
    return !name.empty() &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

void declare(grammar::Block& declaration, const grammar::Block&) {
    const grammar::Form value = grammar::text({.pattern = {"^[a-z0-9_]+$", is_value},
                                               .fault = "'{}' cannot name a value: a-z, 0-9 and _ only",
                                               .type = "name"});
    declaration.keys.push_back(grammar::required(
        "values",
        grammar::list(value, {.min = 2, .unique = true, .fault = "an enum needs at least two 'values'"}),
        "Names of a-z, 0-9 and _."));
}

void read_declaration(const SpecReader& reader, ParamSpec& spec) {
    for (const Node& item : reader.node.find("values")->items) spec.values.push_back(item.string);
}

std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) {
    const std::vector<std::string>& values = reader.spec.values;
    if (!node.is_string()) return reader.wrong_kind(node, "one of " + list_of_names(values));
    if (std::find(values.begin(), values.end(), node.string) == values.end())
        return reader.fault(node, "'" + node.string + "' is not one of " + list_of_names(values) +
                                      did_you_mean(node.string, values));
    return node.string;
}

schema::json literal(const ParamSpec& spec, const schema::LiteralParts&) {
    return spec.values.empty() ? schema::text() : schema::one_of(spec.values);
}

std::string type_text(const ParamSpec& spec) {
    std::string text = "enum:";
    for (std::size_t i = 0; i < spec.values.size(); ++i) text += (i ? ", " : " ") + spec.values[i];
    return text;
}

std::string default_text(const ParamSpec& spec) {
    return std::get<std::string>(spec.default_value);
}

std::vector<double> numbers(const ParamSpec& spec, const ParamValue& value) {
    const auto found = std::find(spec.values.begin(), spec.values.end(), std::get<std::string>(value));
    return {double(found - spec.values.begin())};
}

ParamValue of_numbers(const ParamSpec& spec, const std::vector<double>& numbers) {
    return spec.values.at(std::size_t(numbers.at(0)));
}

std::vector<SweepValue> sweep(const ParamSpec& spec) {
    std::vector<SweepValue> values;
    for (const std::string& name : spec.values) values.push_back({name, name});
    return values;
}

constexpr ParamTypeTraits type() {
    ParamTypeTraits traits;
    traits.name = "enum";
    traits.glsl_type = "int";
    traits.is_integer = true;
    traits.is_choice = true;
    traits.declare = declare;
    traits.read_declaration = read_declaration;
    traits.parse = parse;
    traits.schema = literal;
    traits.type_text = type_text;
    traits.default_text = default_text;
    traits.numbers = numbers;
    traits.of_numbers = of_numbers;
    traits.sweep = sweep;
    return traits;
}

}  // namespace enum_type

constinit const ParamTypeTraits kEnumParam = enum_type::type();

}  // namespace aftershade
