// Values as text.
#include "framework/base/text.h"
#include "framework/document/param_type.h"
#include "framework/document/table_keys.h"
#include "framework/document/units.h"

namespace aftershade {

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
