#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "framework/core/param_type.h"
#include "framework/core/units.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/effect/param_types.h"
#include "framework/image/camera.h"
#include "framework/image/role.h"
#include "framework/pipeline/pass_schema.h"
#include "framework/pipeline/schema.h"
#include "framework/pipeline/schema_role.h"

namespace aftershade {

using schema::json;
using namespace schema_of_effect;

namespace {

constexpr int kMaxElements = 1 << 25;  // of 4 bytes, in a block of 128 MiB

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

json texture() {
    std::vector<std::string> formats;
    for (const auto name : gpu::texture_format_names()) formats.emplace_back(name);
    json result = schema::object({{"format", schema::one_of(formats)},
                                  {"doc", kText},
                                  {"scale", grid_scale()},
                                  {"tile", count(2, 4096)},
                                  {"size", schema::array_of(integer(1, kMaxSide), 2, 2)},
                                  {"layers", integer(1, kMaxLayers)},
                                  {"mips", {{"anyOf", {{{"const", "auto"}}, integer(1, 15)}}}},
                                  {"clear", texel()},
                                  {"history", kFlag},
                                  {"when", when()}},
                                 {"format", "doc"});
    result["not"] = at_most_one({"scale", "tile", "size"});
    return result;
}

json buffer() {
    const std::vector<std::string> elements = {"float", "int",   "uint",  "vec2", "vec4",
                                               "ivec2", "ivec4", "uvec2", "uvec4"};
    json result = schema::object({{"element", schema::one_of(elements)},
                                  {"doc", kText},
                                  {"count", count(1, kMaxElements)},
                                  {"per", per()},
                                  {"clear", schema::any_of({kNumber, schema::array_of(kNumber, 1)})},
                                  {"history", kFlag},
                                  {"indirect", kFlag}},
                                 {"element", "doc"});
    result["anyOf"] = {{{"required", {"per"}}, {"properties", {{"count", count(1, 256)}}}},
                       {{"required", {"count"}}, {"properties", {{"per", false}}}}};
    const json arguments = {{"properties",
                             {{"element", {{"const", "uint"}}},
                              {"count", integer(4, kMaxElements)},
                              {"per", false},
                              {"history", {{"const", false}}}}},
                            {"required", {"count"}}};
    result["if"] = {{"properties", {{"indirect", {{"const", true}}}}}, {"required", {"indirect"}}};
    result["then"] = arguments;
    return result;
}

json native() {
    const json side = integer(1, 1024);
    return schema::object(
        {{"uniforms",
          schema::named(schema::object(
              {{"type", schema::one_of({"float", "int", "uint", "vec2", "vec3", "vec4"})}, {"doc", kText}},
              {"type", "doc"}))},
         {"tables", schema::named(schema::object(
                        {{"element", schema::one_of({"float", "vec2", "vec4", "uint", "uvec2", "uvec4"})},
                         {"count", {{"anyOf", {side, schema::array_of(side, 2, 2)}}}},
                         {"doc", kText}},
                        {"element", "count", "doc"}))}});
}

json uses() {
    json names = schema::array_of(schema::one_of({"lights"}));
    names["uniqueItems"] = true;
    return names;
}

}  // namespace

std::string effect_schema() {
    json input = schema::object({{"role", schema::role()},
                                 {"optional", kFlag},
                                 {"history", kFlag},
                                 {"frame", {{"enum", {-1, 1}}}},
                                 {"from", {{"const", "capture"}}},
                                 {"when", when()},
                                 {"doc", kText}},
                                {"role"});
    input["properties"]["when"]["propertyNames"] = {{"pattern", "^(?!has\\.)"}};
    input["dependentSchemas"]["when"] = {{"required", {"optional"}},
                                         {"properties", {{"optional", {{"const", true}}}}}};
    input["if"] = {{"required", {"frame"}}};
    input["then"] = {
        {"required", {"optional"}},
        {"properties", {{"optional", {{"const", true}}}, {"history", {{"const", false}}}, {"from", false}}}};
    json outputs = schema::named(schema::object({{"role", schema::role()}, {"doc", kText}}, {"role"}));
    outputs["minProperties"] = 1;
    const std::string number = "(0|[1-9][0-9]*)";
    const json version = {{"type", "string"},
                          {"pattern", "^" + number + "\\." + number + "\\." + number + "$"}};
    const json presets = {{"type", "object"}, {"additionalProperties", {{"type", "object"}}}};
    const json number_node = {{"type", "number"}};
    const json statistic = schema::object({{"of", channel()},
                                           {"where", channel()},
                                           {"squared", kFlag},
                                           {"bins", schema::array_of(number_node, 3, 3)},
                                           {"doc", kText}},
                                          {"of"});
    json modules = schema::array_of(schema::snake_case());
    modules["uniqueItems"] = true;
    json result = schema::document("Aftershade effect",
                                   {{"id", schema::snake_case()},
                                    {"version", version},
                                    {"summary", kText},
                                    {"sources", schema::array_of(kText)},
                                    {"accumulates", {{"const", "subframes"}}},
                                    {"modules", modules},
                                    {"uses", uses()},
                                    {"inputs", schema::named(input)},
                                    {"outputs", outputs},
                                    {"params", schema::named(param(false))},
                                    {"textures", schema::named(texture())},
                                    {"buffers", schema::named(buffer())},
                                    {"tiles", schema::named(tile_list())},
                                    {"passes", passes(1)},
                                    {"native", native()},
                                    {"telemetry", schema::named(statistic)},
                                    {"presets", presets}},
                                   {"id", "version", "summary", "inputs", "outputs", "passes"});
    define_passes(result);
    return result.dump(2) + "\n";
}

std::string module_schema() {
    json result = schema::document("Aftershade module",
                                   {{"module", schema::snake_case()},
                                    {"summary", kText},
                                    {"uses", uses()},
                                    {"params", schema::named(param(false))},
                                    {"textures", schema::named(texture())},
                                    {"buffers", schema::named(buffer())},
                                    {"tiles", schema::named(tile_list())},
                                    {"passes", passes(0)}},
                                   {"module", "summary"});
    define_passes(result);
    return result.dump(2) + "\n";
}

}  // namespace aftershade
