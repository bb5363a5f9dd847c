#include "framework/effect/param_schema.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "framework/core/param_type.h"
#include "framework/core/schema_pieces.h"
#include "framework/core/units.h"
#include "framework/effect/param_types.h"
#include "framework/image/camera.h"

namespace aftershade {

using schema::json;

namespace {

const json kText = {{"type", "string"}};
const json kNumber = {{"type", "number"}};

/// What else holds for an object whose `key` is `value`.
json where(const std::string& key, const std::string& value, json then) {
    return {{"if", {{"properties", {{key, {{"const", value}}}}}, {"required", {key}}}},
            {"then", std::move(then)}};
}

/// No such keys.
json without(const std::vector<std::string>& keys) {
    json properties = json::object();
    for (const std::string& key : keys) properties[key] = false;
    return {{"properties", properties}};
}

/// Of a parameter, or of a table's column.
std::vector<ParamType> types_of(bool column) {
    std::vector<ParamType> types;
    for (const ParamType type : param_types())
        if (!column || is_block_type(type)) types.push_back(type);
    return types;
}

/// What a parameter of this type has, and has not, beside what all have.
json rules_of(ParamType type, bool column) {
    ParamSpec any;
    any.type = type;
    any.domain = {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    const bool has_unit = type->has_range, is_block = is_block_type(type);
    if (has_unit) any.unit = schema::kAnyUnit;
    std::vector<std::string> absent, required;
    if (!has_unit) absent = {"unit", "min", "max", "ui"};
    if (type->has_default) required.push_back("default");
    for (const ParamType other : types_of(column))
        for (const OwnKey& key : other->own_keys) {
            if (other != type) absent.push_back(key.name);
            else if (key.required) required.push_back(key.name);
        }
    if (!column && !is_block) absent.insert(absent.end(), {"from"});
    if (!column && !type->is_scalar) absent.push_back("requires");
    json rules = without(absent);
    rules["properties"]["default"] = schema::literal(any);
    if (!column) rules["properties"]["identity"] = schema::literal(any);
    if (!column && !is_block) rules["properties"]["bind"] = {{"const", "uniform"}};
    const std::string of_enums = camera_sources(ParamType::enum_).front();
    if (!column && type->is_choice) rules["properties"]["from"] = {{"const", of_enums}};
    else if (!column && is_block) rules["properties"]["from"] = {{"not", {{"const", of_enums}}}};
    rules["required"] = required;
    return rules;
}

/// The keys that only some types have; those of the types of columns go first.
void add_own_keys(json& keys, bool of_block, const json& column) {
    for (const ParamType type : param_types())
        for (const OwnKey& key : type->own_keys)
            if (is_block_type(type) == of_block) keys[key.name] = key.schema(column);
}

json param(bool column) {
    std::vector<std::string> types;
    json rules = json::array();
    for (const ParamType type : types_of(column)) {
        types.emplace_back(param_type_name(type));
        rules.push_back(where("type", types.back(), rules_of(type, column)));
    }
    json keys = {{"type", schema::one_of(types)},
                 {"doc", kText},
                 {"unit", schema::one_of(unit_names())},
                 {"default", json::object()},
                 {"min", kNumber},
                 {"max", kNumber},
                 {"ui", schema::array_of(kNumber, 2, 2)}};
    add_own_keys(keys, true, {});
    if (!column) {
        std::vector<std::string> sources = camera_sources(ParamType::enum_);
        for (std::string& source : camera_sources(ParamType::float_)) sources.push_back(std::move(source));
        keys["bind"] = schema::one_of({"uniform", "define"});
        keys["from"] = schema::one_of(sources);
        keys["identity"] = json::object();
        keys["requires"] =
            schema::array_of({{"type", "string"}, {"pattern", R"(^\s*(<|<=|>|>=)\s*[a-z][a-z0-9_]*\s*$)"}});
        add_own_keys(keys, false, param(true));
    }
    json result = schema::object(keys, {"type", "doc"});
    result["allOf"] = rules;
    return result;
}

}  // namespace

std::string param_schema() {
    return param(false).dump();
}

}  // namespace aftershade
