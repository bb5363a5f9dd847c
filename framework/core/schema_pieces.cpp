#include "framework/core/schema_pieces.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "framework/core/units.h"

namespace aftershade::schema {

namespace {

/// What parse_quantity() takes, for the units that convert to `unit`.
std::string unit_pattern(const std::string& unit) {
    std::string units;
    for (const std::string& name : unit == kAnyUnit ? unit_names() : compatible_units(unit))
        units += (units.empty() ? "" : "|") + name;
    return "^[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)? *(" + units + ")$";
}

/// Makes the literals of one document's kind.
class LiteralWriter {
public:
    explicit LiteralWriter(Variables variables) : variables_(variables) {}

    json literal(const ParamSpec& spec) const {
        switch (spec.type) {
            case ParamType::bool_: return part({{"type", "boolean"}});
            case ParamType::enum_: return part(spec.values.empty() ? text() : one_of(spec.values));
            case ParamType::float_:
            case ParamType::angle:
            case ParamType::int_: return part(quantity(spec));
            case ParamType::color:
            case ParamType::vec2:
            case ParamType::vec3:
            case ParamType::vec4: {
                ParamSpec component = spec;
                component.type = ParamType::float_;
                const int count = component_count(spec.type);
                return part(array_of(part(quantity(component)), count, count));
            }
            case ParamType::curve: return part(curve(spec));
            case ParamType::file: return part(text());
            case ParamType::table: return part(table(spec));
            case ParamType::objects: return part(objects());
            case ParamType::scattering_profile: return part(scattering());
        }
        return json::object();
    }

private:
    json part(json form) const {
        return variables_ == Variables::yes ? any_of({std::move(form), variable()}) : form;
    }

    json curve(const ParamSpec& spec) const {
        const json x = {{"type", "number"}, {"minimum", spec.domain[0]}, {"maximum", spec.domain[1]}};
        ParamSpec y = spec;
        y.type = ParamType::float_;
        const json point = {{"type", "array"},
                            {"prefixItems", {part(x), part(quantity(y))}},
                            {"minItems", 2},
                            {"maxItems", 2}};
        const json points = array_of(part(point), 1, int(kMaxCurvePoints));
        const json interpolation = part(one_of({"linear", "smooth"}));
        return any_of(
            {points, object({{"points", part(points)}, {"interpolation", interpolation}}, {"points"})});
    }

    /// A row says by one key which objects it is for.
    static json one_key() {
        return {{{"required", {"object"}}}, {{"required", {"objects"}}}, {{"required", {"name"}}}};
    }

    json table(const ParamSpec& spec) const {
        // A declaration's columns are not known where the schema is of every declaration.
        if (spec.columns.empty()) {
            const json row = {{"type", "object"}};
            json keyed = row;
            keyed["oneOf"] = one_key();
            return object({{"default", row}, {"rows", array_of(keyed)}});
        }
        json cells = json::object();
        for (const ParamSpec& column : spec.columns) {
            cells[column.name] = literal(column);
            cells[column.name]["description"] = column.doc;
        }
        return object({{"default", part(object(cells))}, {"rows", part(array_of(part(keyed_row(cells))))}});
    }

    json keyed_row(json cells) const {
        cells["object"] = part({{"type", "integer"}, {"minimum", 0}, {"maximum", UINT32_MAX}});
        cells["objects"] = part({{"type", "string"},
                                 {"description", "Ids: \"3-7,9\"."},
                                 {"pattern", "^ *[0-9]+ *(- *[0-9]+ *)?(, *[0-9]+ *(- *[0-9]+ *)?)*$"}});
        cells["name"] = part({{"type", "string"}, {"minLength", 1}});
        json keyed = object(std::move(cells));
        keyed["oneOf"] = one_key();
        return keyed;
    }

    json objects() const { return array_of(part(object_key())); }

    json scattering() const {
        const json profile = part(any_of({text(), scattering_profile(variables_)}));
        json row = keyed_row({{"profile", profile}});
        row["required"] = {"profile"};
        json rows =
            object({{"default", profile}, {"rows", part(array_of(part(std::move(row))))}}, {"default"});
        return any_of({text(), scattering_profile(variables_), std::move(rows)});
    }

    Variables variables_;
};

}  // namespace

json object(json properties, std::vector<std::string> required) {
    json result = {
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
    if (!required.empty()) result["required"] = std::move(required);
    return result;
}

json named(const json& value) {
    return {
        {"type", "object"}, {"propertyNames", {{"pattern", kSnakeCase}}}, {"additionalProperties", value}};
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

json any_of(std::vector<json> forms) {
    return {{"anyOf", std::move(forms)}};
}

json text() {
    return {{"type", "string"}};
}

json snake_case() {
    return {{"type", "string"}, {"pattern", kSnakeCase}};
}

json quantity(const ParamSpec& spec) {
    json number = {{"type", spec.type == ParamType::int_ ? "integer" : "number"}};
    if (spec.min) number["minimum"] = *spec.min;
    if (spec.max) number["maximum"] = *spec.max;
    if (spec.unit.empty()) return number;
    return any_of({number, {{"type", "string"}, {"pattern", unit_pattern(spec.unit)}}});
}

json variable() {
    return {{"$ref", "#/$defs/Variable"}};
}

void define_variable(json& definitions) {
    definitions["Variable"] =
        object({{"var", {{"type", "string"}, {"description", "Name of a variable of \"vars\"."}}}}, {"var"});
}

json literal(const ParamSpec& spec, Variables variables) {
    return LiteralWriter(variables).literal(spec);
}

json object_key() {
    json key = any_of({{{"type", "integer"}, {"minimum", 0}, {"maximum", UINT32_MAX}},
                       {{"type", "string"}, {"minLength", 1}}});
    key["description"] = "An object's id, ids and ranges of ids (\"3-7,9\") or a Cryptomatte name.";
    return key;
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
