#include "framework/pipeline/schema_common.h"

#include <utility>

#include "framework/core/units.h"

namespace aftershade::schema {

namespace {

/// What parse_quantity() takes, for the units that convert to `unit`.
std::string unit_pattern(const std::string& unit) {
    std::string units;
    for (const std::string& name : compatible_units(unit)) units += (units.empty() ? "" : "|") + name;
    return "^\\s*[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?\\s*(" + units + ")\\s*$";
}

json curve(const ParamSpec& spec) {
    json x = {{"type", "number"}, {"minimum", spec.domain[0]}, {"maximum", spec.domain[1]}};
    json y = {{"type", "number"}};
    if (spec.min) y["minimum"] = *spec.min;
    if (spec.max) y["maximum"] = *spec.max;
    const json point = {{"type", "array"}, {"prefixItems", {x, y}}, {"minItems", 2}, {"items", false}};
    const json points = array_of(point, 1, int(kMaxCurvePoints));
    return {{"anyOf",
             {points,
              object({{"points", points}, {"interpolation", one_of({"linear", "smooth"})}}, {"points"})}}};
}

json table(const ParamSpec& spec) {
    json cells = json::object();
    for (const ParamSpec& column : spec.columns) {
        cells[column.name] = literal(column);
        cells[column.name]["description"] = column.doc;
    }
    json row = cells;
    row["object"] = {{"type", "integer"}, {"minimum", 0}, {"maximum", 4294967295u}};
    row["objects"] = {{"type", "string"}, {"pattern", "^[0-9]+(-[0-9]+)?(,[0-9]+(-[0-9]+)?)*$"}};
    row["name"] = text();
    json keyed = object(row);
    keyed["oneOf"] = {{{"required", {"object"}}}, {{"required", {"objects"}}}, {{"required", {"name"}}}};
    return object({{"default", object(cells)}, {"rows", array_of(keyed)}});
}

}  // namespace

json object(json properties, std::vector<std::string> required) {
    json result = {
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
    if (!required.empty()) result["required"] = std::move(required);
    return result;
}

json array_of(json items, int min, int max) {
    json result = {{"type", "array"}, {"items", std::move(items)}};
    if (min > 0) result["minItems"] = min;
    if (max >= 0) result["maxItems"] = max;
    return result;
}

json one_of(const std::vector<std::string>& words) {
    return {{"enum", words}};
}

json text() {
    return {{"type", "string"}};
}

json quantity(const ParamSpec& spec) {
    json number = {{"type", spec.type == ParamType::int_ ? "integer" : "number"}};
    if (spec.min) number["minimum"] = *spec.min;
    if (spec.max) number["maximum"] = *spec.max;
    if (spec.unit.empty()) return number;
    return {{"anyOf", {number, {{"type", "string"}, {"pattern", unit_pattern(spec.unit)}}}}};
}

json literal(const ParamSpec& spec) {
    switch (spec.type) {
        case ParamType::bool_: return {{"type", "boolean"}};
        case ParamType::enum_: return one_of(spec.values);
        case ParamType::float_:
        case ParamType::angle:
        case ParamType::int_: return quantity(spec);
        case ParamType::color:
        case ParamType::vec2:
        case ParamType::vec3:
        case ParamType::vec4: {
            ParamSpec component = spec;
            component.type = ParamType::float_;
            return array_of(quantity(component), component_count(spec.type), component_count(spec.type));
        }
        case ParamType::curve: return curve(spec);
        case ParamType::file: return text();
        case ParamType::table: return table(spec);
    }
    return json::object();
}

json document(const std::string& title, json properties, std::vector<std::string> required) {
    json all = {{"$schema", text()},
                {"aftershade", {{"const", 1}, {"description", "Version of the format."}}}};
    all.update(properties);
    required.insert(required.begin(), "aftershade");
    json result = {{"$schema", kDraft}, {"title", title}};
    result.update(object(std::move(all), std::move(required)));
    return result;
}

}  // namespace aftershade::schema
