// Values of parameters: the parts that types share, text, values between two others, and values for images of
// another size.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <typeinfo>

#include <nlohmann/json.hpp>

#include "framework/base/text.h"
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

double scaled_px(const ParamSpec& spec, double number, double factor) {
    if (!spec.type->is_integer) return number * factor;
    const double rounded = std::clamp(std::round(number * factor), -2147483648.0, 2147483647.0);
    return spec.min ? std::max(rounded, std::ceil(*spec.min)) : rounded;
}

ParamValue interpolate(const ParamSpec& spec, const ParamValue& a, const ParamValue& b, double t) {
    if (!spec.type->is_continuous) return t < 1 ? a : b;
    std::vector<double> numbers = numbers_of(spec, a);
    const std::vector<double> ends = numbers_of(spec, b);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = std::lerp(numbers[i], ends[i], t);
    return value_of_numbers(spec, numbers);
}

ParamValue scale_pixels(const ParamSpec& spec, const ParamValue& value, double factor) {
    return spec.type->scale(spec, value, factor);
}

ParamValue AbstractParamType::scale(const ParamSpec& spec, const ParamValue& value, double factor) const {
    if (spec.unit != "px" || !is_block_type(spec.type)) return value;
    std::vector<double> numbers = numbers_of(spec, value);
    for (double& number : numbers) number = scaled_px(spec, number, factor);
    return value_of_numbers(spec, numbers);
}

std::string format_numbers(const std::vector<double>& numbers) {
    std::string text = "[";
    for (std::size_t i = 0; i < numbers.size(); ++i) text += (i ? ", " : "") + format_number(numbers[i]);
    return text + "]";
}

namespace {

std::string text_of(const CurveValue& curve) {
    std::string points = "[";
    for (std::size_t i = 0; i < curve.points.size(); ++i)
        points += (i ? ", " : "") + format_numbers({curve.points[i][0], curve.points[i][1]});
    points += "]";
    if (curve.interpolation == CurveValue::Interpolation::linear) return points;
    return "{\"points\": " + points + ", \"interpolation\": \"smooth\"}";
}

std::string text_of_cell(const ParamSpec& column, const std::vector<double>& cell) {
    return format_value(column, value_of_numbers(column, cell));
}

std::string text_of_cell(const std::vector<double>& cell) {
    return cell.size() == 1 ? format_number(cell[0]) : format_numbers(cell);
}

/// The members of a row's object, without braces. Columns that do not differ from `usual` are left out.
std::string text_of_row(const std::vector<ParamSpec>* columns, const TableValue::Row& row,
                        const TableValue::Row* usual) {
    std::string text;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (columns && usual && row[i] == (*usual)[i]) continue;
        text += text.empty() ? "" : ", ";
        text += columns ? json_string((*columns)[i].name) + ": " + text_of_cell((*columns)[i], row[i])
                        : text_of_cell(row[i]);
    }
    return columns ? text : "\"cells\": [" + text + "]";
}

}  // namespace

std::string format_table(const TableValue& table, const std::vector<ParamSpec>* columns) {
    std::string rows;
    for (const auto& [key, row] : table.rows) {
        const std::string cells = text_of_row(columns, row, &table.default_row);
        rows += (rows.empty() ? "{" : ", {") + format_key(key) + (cells.empty() ? "" : ", ") + cells + "}";
    }
    return "{\"default\": {" + text_of_row(columns, table.default_row, nullptr) + "}, \"rows\": [" + rows +
           "]}";
}

std::string format_value(const ParamValue& value) {
    struct Visitor {
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(std::int64_t v) const { return std::to_string(v); }
        std::string operator()(double v) const { return format_number(v); }
        std::string operator()(const std::string& v) const { return json_string(v); }
        std::string operator()(const std::vector<double>& v) const { return format_numbers(v); }
        std::string operator()(const CurveValue& v) const { return text_of(v); }
        std::string operator()(const TableValue& v) const { return format_table(v, nullptr); }
        std::string operator()(const OpaqueValue& v) const { return v.content().text(); }
    };
    return std::visit(Visitor{}, value);
}

std::string format_value(const ParamSpec& spec, const ParamValue& value) {
    return spec.type->format(spec, value);
}

std::string AbstractParamType::format(const ParamSpec&, const ParamValue& value) const {
    return format_value(value);
}

std::string range_text(const ParamSpec& spec) {
    if (spec.min && spec.max) return format_number(*spec.min) + " to " + format_number(*spec.max);
    if (spec.min) return "at least " + format_number(*spec.min);
    return spec.max ? "at most " + format_number(*spec.max) : "";
}

}  // namespace aftershade
