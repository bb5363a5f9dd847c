// Values between two others, and values for images of another size.
#include <algorithm>
#include <cmath>

#include "framework/core/param.h"

namespace aftershade {

namespace {

/// As many pixels as `value` at full size, within 32 bits.
double scaled(const ParamSpec& spec, double value, double factor) {
    if (spec.type != ParamType::int_) return value * factor;
    const double rounded = std::clamp(std::round(value * factor), -2147483647.0, 2147483647.0);
    return spec.min ? std::max(rounded, std::ceil(*spec.min)) : rounded;
}

struct PixelScaler {
    const ParamSpec& spec;
    double factor;

    ParamValue operator()(bool v) const { return v; }
    ParamValue operator()(const std::string& v) const { return v; }
    ParamValue operator()(std::int64_t v) const { return std::int64_t(scaled(spec, double(v), factor)); }
    ParamValue operator()(double v) const { return scaled(spec, v, factor); }
    ParamValue operator()(std::vector<double> v) const {
        for (double& component : v) component = scaled(spec, component, factor);
        return v;
    }
    ParamValue operator()(CurveValue v) const {
        for (auto& point : v.points) point[1] = scaled(spec, point[1], factor);
        return v;
    }
    ParamValue operator()(const TableValue& v) const { return v; }
    ParamValue operator()(const ScatteringValue& v) const { return v; }
};

void scale_row(const ParamSpec& table, TableValue::Row& row, double factor) {
    for (std::size_t i = 0; i < row.size(); ++i)
        if (table.columns[i].unit == "px")
            for (double& number : row[i]) number = scaled(table.columns[i], number, factor);
}

}  // namespace

ParamValue interpolate(const ParamSpec& spec, const ParamValue& a, const ParamValue& b, double t) {
    switch (spec.type) {
        case ParamType::float_:
        case ParamType::angle: return std::lerp(std::get<double>(a), std::get<double>(b), t);
        case ParamType::color:
        case ParamType::vec2:
        case ParamType::vec3:
        case ParamType::vec4: {
            std::vector<double> values = std::get<std::vector<double>>(a);
            const auto& ends = std::get<std::vector<double>>(b);
            for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::lerp(values[i], ends[i], t);
            return values;
        }
        default: return t < 1 ? a : b;
    }
}

ParamValue scale_pixels(const ParamSpec& spec, const ParamValue& value, double factor) {
    if (spec.type == ParamType::table) {
        TableValue table = std::get<TableValue>(value);
        scale_row(spec, table.default_row, factor);
        for (auto& [key, row] : table.rows) scale_row(spec, row, factor);
        return table;
    }
    return spec.unit == "px" ? std::visit(PixelScaler{spec, factor}, value) : value;
}

}  // namespace aftershade
