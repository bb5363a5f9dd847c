#include "framework/document/schema_pieces.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "framework/document/param_type.h"
#include "framework/document/units.h"

namespace aftershade::schema {

namespace {

/// What parse_quantity() takes, for the units that convert to `unit`.
std::string unit_pattern(const std::string& unit) {
    std::string units;
    for (const std::string& name : unit == kAnyUnit ? unit_names() : compatible_units(unit))
        units += (units.empty() ? "" : "|") + name;
    return "^[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)? *(" + units + ")$";
}

}  // namespace

json object(json properties, const std::vector<std::string>& required) {
    json result = {
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
    if (!required.empty()) result["required"] = required;
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
    json number = {{"type", spec.type->is_integer ? "integer" : "number"}};
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
    const LiteralParts parts(variables);
    return parts.part(spec.type->literal_schema(spec, parts));
}

json LiteralParts::part(json form) const {
    return variables_ == Variables::yes ? any_of({std::move(form), variable()}) : form;
}

json LiteralParts::one_key() {
    return {{{"required", {"object"}}}, {{"required", {"objects"}}}, {{"required", {"name"}}}};
}

json LiteralParts::literal(const ParamSpec& spec) const {
    return schema::literal(spec, variables_);
}

json LiteralParts::keyed_row(json cells) const {
    cells["object"] = part({{"type", "integer"}, {"minimum", 0}, {"maximum", UINT32_MAX}});
    cells["objects"] = part({{"type", "string"},
                             {"description", "Ids: \"3-7,9\"."},
                             {"pattern", "^ *[0-9]+ *(- *[0-9]+ *)?(, *[0-9]+ *(- *[0-9]+ *)?)*$"}});
    cells["name"] = part({{"type", "string"}, {"minLength", 1}});
    json keyed = object(std::move(cells));
    keyed["oneOf"] = one_key();
    return keyed;
}

json object_key() {
    json key = any_of({{{"type", "integer"}, {"minimum", 0}, {"maximum", UINT32_MAX}},
                       {{"type", "string"}, {"minLength", 1}}});
    key["description"] = "An object's id, ids and ranges of ids (\"3-7,9\") or a Cryptomatte name.";
    return key;
}

json document(const std::string& title, const json& properties, std::vector<std::string> required) {
    json all = {{"$schema", text()},
                {"aftershade", {{"const", 1}, {"description", "Version of the format."}}}};
    all.update(properties);
    required.insert(required.begin(), "aftershade");
    json result = {{"$schema", kDraft}, {"title", title}};
    result.update(object(std::move(all), std::move(required)));
    return result;
}

}  // namespace aftershade::schema
