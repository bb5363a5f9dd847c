#include <cassert>
#include <nlohmann/json.hpp>
#include <typeinfo>

#include "framework/document/param_type.h"
#include "framework/document/table_keys.h"
#include "framework/document/units.h"

namespace aftershade {

std::string with_unit(double value, const std::string& unit) {
    return format_number(value) + (unit.empty() ? "" : " " + unit);
}

std::nullopt_t ValueReader::fault(const Node& node, const std::string& text) const {
    diagnostics.error(node.place, label + ": " + text);
    return std::nullopt;
}

std::nullopt_t ValueReader::wrong_kind(const Node& node, std::string_view expected) const {
    return fault(node, "expected " + std::string(expected) + ", not " + std::string(kind_name(node.kind)));
}

std::optional<double> ValueReader::in_range(const Node& node, double value) const {
    if (spec.min && value < *spec.min)
        return fault(
            node, with_unit(value, spec.unit) + " is below the minimum " + with_unit(*spec.min, spec.unit));
    if (spec.max && value > *spec.max)
        return fault(
            node, with_unit(value, spec.unit) + " is above the maximum " + with_unit(*spec.max, spec.unit));
    return value;
}

std::optional<double> ValueReader::scalar(const Node& node) const {
    if (node.is_number()) return in_range(node, node.number);
    const std::string expected = spec.unit.empty() ? "a number" : "a number in " + spec.unit;
    if (!node.is_string()) return wrong_kind(node, expected);
    const auto quantity = parse_quantity(node.string);
    if (!quantity) {
        const bool has_unit = !spec.unit.empty();
        const std::string remedy = has_unit ? " or a string such as \"1 " + spec.unit + "\"" : "";
        return fault(node, "'" + node.string + "' is not " + expected + remedy);
    }
    if (spec.unit.empty()) return fault(node, "'" + node.string + "' has a unit, but this is a pure number");
    const auto converted = convert_unit(quantity->value, quantity->unit, spec.unit);
    if (!converted)
        return fault(node, "'" + node.string + "' cannot be converted to " + spec.unit + "; write " +
                               list_of_names(compatible_units(spec.unit)));
    return in_range(node, *converted);
}

bool OpaqueValue::operator==(const OpaqueValue& other) const {
    const ValueContent &mine = content(), &its = other.content();
    return content_ == other.content_ || (typeid(mine) == typeid(its) && mine.equals(its));
}

std::optional<ParamValue> parse_param_value(const ParamSpec& spec, const Node& node, const std::string& label,
                                            Diagnostics& diagnostics) {
    return spec.type->parse({spec, label, diagnostics}, node);
}

void AbstractParamType::declare(grammar::Block&, const grammar::Block&) const {}

bool AbstractParamType::check_default(const ParamSpec&, const Node&, const std::string&, Diagnostics&) const {
    return true;
}

std::string AbstractParamType::type_text(const ParamSpec&) const {
    return std::string(name);
}

std::string AbstractParamType::default_text(const ParamSpec& spec) const {
    return format(spec, spec.default_value);
}

nlohmann::ordered_json AbstractParamType::describe(const ParamSpec&) const {
    return nlohmann::ordered_json::object();
}

std::vector<double> AbstractParamType::numbers(const ParamSpec&, const ParamValue&) const {
    return {};
}

ParamValue AbstractParamType::of_numbers(const ParamSpec&, const std::vector<double>&) const {
    return {};
}

std::size_t AbstractParamTable::entries(const ParamValue& value) const {
    return count_entries(rows(value).rows);
}

std::vector<double> numbers_of(const ParamSpec& spec, const ParamValue& value) {
    assert(is_block_type(spec.type));
    return spec.type->numbers(spec, value);
}

ParamValue value_of_numbers(const ParamSpec& spec, const std::vector<double>& numbers) {
    assert(is_block_type(spec.type));
    return spec.type->of_numbers(spec, numbers);
}

std::vector<SweepValue> sweep_values(const ParamSpec& spec) {
    if (!is_block_type(spec.type)) return {};
    return spec.type->sweep(spec);
}

std::vector<SweepValue> AbstractParamType::sweep(const ParamSpec& spec) const {
    std::vector<SweepValue> values;
    for (const auto& [end, limit] : {std::pair("min", spec.min), {"max", spec.max}}) {
        if (!limit) continue;
        const std::vector<double> numbers(std::size_t(component_count(spec.type)), *limit);
        ParamValue value = value_of_numbers(spec, numbers);
        values.push_back({"at its " + std::string(end) + ", " + format_value(spec, value), std::move(value)});
    }
    return values;
}

}  // namespace aftershade
