// One of a few names.
#include <algorithm>
#include <cstdint>
#include <set>

#include <nlohmann/json.hpp>

#include "framework/document/grammar.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/units.h"

namespace aftershade {

namespace enum_type {

/// Shaders see a value as a preprocessor symbol: SHAPE_HEXAGON.
bool is_value(const std::string& name) {
    return !name.empty() &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

/// The value that a whole number stands for; nullptr: none.
const std::string* value_of_number(const ParamSpec& spec, std::int64_t number) {
    if (spec.numbers.empty()) return nullptr;
    const auto named = std::ranges::find(spec.values, std::to_string(number));
    if (named != spec.values.end()) return &*named;
    const auto found = std::ranges::find(spec.numbers, number);
    return found == spec.numbers.end() ? nullptr : &spec.values[std::size_t(found - spec.numbers.begin())];
}

class EnumType final : public AbstractParamType {
public:
    constexpr EnumType()
        : AbstractParamType({.name = "enum", .glsl_type = "int", .is_integer = true, .is_choice = true}) {}

    void declare(grammar::Block& declaration, const grammar::Block&) const override {
        const grammar::Form value = grammar::text({.pattern = {"^[a-z0-9_]+$", is_value},
                                                   .fault = "'{}' cannot name a value: a-z, 0-9 and _ only",
                                                   .type = "name"});
        declaration.keys.push_back(grammar::required(
            "values",
            grammar::list(value, {.min = 2, .unique = true, .fault = "an enum needs at least two 'values'"}),
            "Names of a-z, 0-9 and _."));
        declaration.keys.push_back(
            grammar::optional("numbers", grammar::list(grammar::integer(INT32_MIN, INT32_MAX), {.min = 2}),
                              "Whole numbers that stand for the values, too, one for each. A value whose "
                              "name is that number goes "
                              "before."));
    }

    void read_declaration(const SpecReader& reader, ParamSpec& spec) const override {
        for (const Node& item : reader.node.find("values")->items) spec.values.push_back(item.string);
        const Node* numbers = reader.node.find("numbers");
        if (!numbers) return;
        for (const Node& item : numbers->items) spec.numbers.push_back(int(item.integer));
        if (spec.numbers.size() != spec.values.size())
            reader.diagnostics.error(numbers->place, "'numbers' has " + std::to_string(spec.numbers.size()) +
                                                         " entries, but 'values' " +
                                                         std::to_string(spec.values.size()) +
                                                         "; each value needs one");
    }

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        const std::vector<std::string>& values = reader.spec.values;
        if (node.kind == Node::Kind::integer)
            if (const std::string* value = value_of_number(reader.spec, node.integer)) return *value;
        if (!node.is_string()) return reader.wrong_kind(node, "one of " + list_of_names(values));
        if (std::find(values.begin(), values.end(), node.string) == values.end())
            return reader.fault(node, "'" + node.string + "' is not one of " + list_of_names(values) +
                                          did_you_mean(node.string, values));
        return node.string;
    }

    schema::json literal_schema(const ParamSpec& spec, const schema::LiteralParts&) const override {
        if (spec.values.empty()) return schema::text();
        if (spec.numbers.empty()) return schema::one_of(spec.values);
        std::set<std::int64_t> numbers(spec.numbers.begin(), spec.numbers.end());
        for (const std::string& value : spec.values)
            if (const auto number = parse_number(value);
                number && std::to_string(std::int64_t(*number)) == value)
                numbers.insert(std::int64_t(*number));
        return schema::any_of({schema::one_of(spec.values), {{"enum", numbers}}});
    }

    std::string type_text(const ParamSpec& spec) const override {
        std::string text = "enum:";
        for (std::size_t i = 0; i < spec.values.size(); ++i) text += (i ? ", " : " ") + spec.values[i];
        return text;
    }

    std::string default_text(const ParamSpec& spec) const override {
        return std::get<std::string>(spec.default_value);
    }

    std::vector<double> numbers(const ParamSpec& spec, const ParamValue& value) const override {
        const auto found = std::find(spec.values.begin(), spec.values.end(), std::get<std::string>(value));
        return {double(found - spec.values.begin())};
    }

    ParamValue of_numbers(const ParamSpec& spec, const std::vector<double>& numbers) const override {
        return spec.values.at(std::size_t(numbers.at(0)));
    }

    std::vector<SweepValue> sweep(const ParamSpec& spec) const override {
        std::vector<SweepValue> values;
        for (const std::string& value : spec.values) values.push_back({value, value});
        return values;
    }
};

constexpr EnumType kType;

}  // namespace enum_type

constinit const ParamType ParamType::enum_{enum_type::kType};

}  // namespace aftershade
