#include "framework/core/param_internal.h"

#include <algorithm>
#include <cassert>
#include <cmath>

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

std::optional<ParamValue> ValueReader::vector(const Node& node) const {
    const std::size_t count = std::size_t(component_count(spec.type));
    if (!node.is_array() || node.items.size() != count)
        return fault(node, "expected an array of " + std::to_string(count) + " numbers");
    std::vector<double> values;
    for (const Node& item : node.items)
        if (const auto value = scalar(item)) values.push_back(*value);
    if (values.size() != count) return std::nullopt;
    return values;
}

std::optional<ParamValue> ValueReader::integer(const Node& node) const {
    const auto value = scalar(node);
    if (!value) return std::nullopt;
    if (*value != std::floor(*value)) return fault(node, format_number(*value) + " is not a whole number");
    if (std::abs(*value) > 2147483647.0) return fault(node, format_number(*value) + " does not fit 32 bits");
    return std::int64_t(*value);
}

std::optional<ParamValue> ValueReader::enumerator(const Node& node) const {
    if (!node.is_string()) return wrong_kind(node, "one of " + list_of_names(spec.values));
    if (std::find(spec.values.begin(), spec.values.end(), node.string) == spec.values.end())
        return fault(node, "'" + node.string + "' is not one of " + list_of_names(spec.values) +
                               did_you_mean(node.string, spec.values));
    return node.string;
}

std::optional<ParamValue> ValueReader::file(const Node& node) const {
    if (!node.is_string()) return wrong_kind(node, "the path of a file, or \"\" for none");
    if (node.string.find('\0') != std::string::npos) return fault(node, "a path holds no zero byte");
    return node.string;
}

std::optional<ParamValue> parse_param_value(const ParamSpec& spec, const Node& node, const std::string& label,
                                            Diagnostics& diagnostics) {
    const ValueReader reader{spec, label, diagnostics};
    switch (spec.type) {
        case ParamType::bool_:
            if (node.kind != Node::Kind::boolean) return reader.wrong_kind(node, "true or false");
            return node.boolean;
        case ParamType::int_: return reader.integer(node);
        case ParamType::enum_: return reader.enumerator(node);
        case ParamType::float_:
        case ParamType::angle: {
            const auto value = reader.scalar(node);
            return value ? std::optional<ParamValue>(*value) : std::nullopt;
        }
        case ParamType::color:
        case ParamType::vec2:
        case ParamType::vec3:
        case ParamType::vec4: return reader.vector(node);
        case ParamType::curve: return reader.curve(node);
        case ParamType::file: return reader.file(node);
        case ParamType::table: return reader.table(node);
        case ParamType::objects: return reader.objects(node);
        case ParamType::scattering_profile: return reader.scattering(node);
    }
    return std::nullopt;
}

std::vector<double> numbers_of(const ParamSpec& spec, const ParamValue& value) {
    struct Visitor {
        const ParamSpec& spec;
        std::vector<double> operator()(bool v) const { return {v ? 1.0 : 0.0}; }
        std::vector<double> operator()(std::int64_t v) const { return {double(v)}; }
        std::vector<double> operator()(double v) const { return {v}; }
        std::vector<double> operator()(const std::string& v) const {
            return {double(std::find(spec.values.begin(), spec.values.end(), v) - spec.values.begin())};
        }
        std::vector<double> operator()(const std::vector<double>& v) const { return v; }
        std::vector<double> operator()(const CurveValue&) const { return {}; }
        std::vector<double> operator()(const TableValue&) const { return {}; }
        std::vector<double> operator()(const ScatteringValue&) const { return {}; }
    };
    assert(is_block_type(spec.type));
    return std::visit(Visitor{spec}, value);
}

}  // namespace aftershade
