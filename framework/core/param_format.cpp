// Values as text.
#include "framework/core/param_internal.h"
#include "framework/core/text.h"

namespace aftershade {

namespace {

std::string array_of(const std::vector<double>& numbers) {
    std::string text = "[";
    for (std::size_t i = 0; i < numbers.size(); ++i) text += (i ? ", " : "") + format_number(numbers[i]);
    return text + "]";
}

std::string text_of(const CurveValue& curve) {
    std::string points = "[";
    for (std::size_t i = 0; i < curve.points.size(); ++i)
        points += (i ? ", " : "") + array_of({curve.points[i][0], curve.points[i][1]});
    points += "]";
    if (curve.interpolation == CurveValue::Interpolation::linear) return points;
    return "{\"points\": " + points + ", \"interpolation\": \"smooth\"}";
}

std::string text_of_cell(const ParamSpec& column, const std::vector<double>& cell) {
    if (column.type == ParamType::bool_) return cell.at(0) != 0 ? "true" : "false";
    if (column.type == ParamType::enum_) return json_string(column.values.at(std::size_t(cell.at(0))));
    return component_count(column.type) > 1 ? array_of(cell) : format_number(cell.at(0));
}

std::string text_of_cell(const std::vector<double>& cell) {
    return cell.size() == 1 ? format_number(cell[0]) : array_of(cell);
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

std::string text_of_key(const TableKey& key) {
    if (!key.name.empty()) return "\"name\": " + json_string(key.name);
    if (key.first == key.last) return "\"object\": " + std::to_string(key.first);
    return "\"objects\": \"" + std::to_string(key.first) + "-" + std::to_string(key.last) + "\"";
}

std::string text_of(const TableValue& table, const std::vector<ParamSpec>* columns) {
    std::string rows;
    for (const auto& [key, row] : table.rows) {
        const std::string cells = text_of_row(columns, row, &table.default_row);
        rows += (rows.empty() ? "{" : ", {") + text_of_key(key) + (cells.empty() ? "" : ", ") + cells + "}";
    }
    return "{\"default\": {" + text_of_row(columns, table.default_row, nullptr) + "}, \"rows\": [" + rows +
           "]}";
}

std::string text_of_list(const TableValue& objects) {
    std::string items;
    for (const auto& [key, row] : objects.rows) {
        items += items.empty() ? "" : ", ";
        items += format_object_keys({&key, 1});
    }
    return "[" + items + "]";
}

std::string text_of(const ScatteringValue& value) {
    const std::string usual = format_scattering_profile(value.usual);
    if (value.rows.empty()) return usual;
    std::string rows;
    for (const auto& [key, profile] : value.rows)
        rows += (rows.empty() ? "{" : ", {") + text_of_key(key) +
                ", \"profile\": " + format_scattering_profile(profile) + "}";
    return "{\"default\": " + usual + ", \"rows\": [" + rows + "]}";
}

}  // namespace

std::string format_value(const ParamValue& value) {
    struct Visitor {
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(std::int64_t v) const { return std::to_string(v); }
        std::string operator()(double v) const { return format_number(v); }
        std::string operator()(const std::string& v) const { return json_string(v); }
        std::string operator()(const std::vector<double>& v) const { return array_of(v); }
        std::string operator()(const CurveValue& v) const { return text_of(v); }
        std::string operator()(const TableValue& v) const { return text_of(v, nullptr); }
        std::string operator()(const ScatteringValue& v) const { return text_of(v); }
    };
    return std::visit(Visitor{}, value);
}

std::string format_value(const ParamSpec& spec, const ParamValue& value) {
    if (spec.type == ParamType::objects) return text_of_list(std::get<TableValue>(value));
    if (const auto* table = std::get_if<TableValue>(&value)) return text_of(*table, &spec.columns);
    return format_value(value);
}

std::string range_text(const ParamSpec& spec) {
    if (spec.min && spec.max) return format_number(*spec.min) + " to " + format_number(*spec.max);
    if (spec.min) return "at least " + format_number(*spec.min);
    return spec.max ? "at most " + format_number(*spec.max) : "";
}

}  // namespace aftershade
