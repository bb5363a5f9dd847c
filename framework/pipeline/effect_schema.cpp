#include <limits>
#include <utility>

#include "framework/core/units.h"
#include "framework/effect/manifest.h"
#include "framework/image/camera.h"
#include "framework/image/role.h"
#include "framework/pipeline/schema.h"
#include "framework/pipeline/schema_role.h"

namespace aftershade {

using schema::json;

namespace {

const json kText = {{"type", "string"}};
const json kName = {{"type", "string"}, {"minLength", 1}};
const json kFlag = {{"type", "boolean"}};
const json kNumber = {{"type", "number"}};
constexpr int kMostLevel = 14;         // of 16384 texels a side
constexpr int kMaxElements = 1 << 25;  // of 4 bytes, in a block of 128 MiB

json integer(int min, int max) {
    return {{"type", "integer"}, {"minimum", min}, {"maximum", max}};
}

/// A number, or the name of an int parameter.
json count(int min, int max) {
    return {{"anyOf", {integer(min, max), schema::snake_case()}}};
}

/// A value of every channel, or four of them.
json texel() {
    return schema::any_of({kNumber, schema::array_of(kNumber, 1, 1), schema::array_of(kNumber, 4, 4)});
}

json at_most_one(const std::vector<std::string>& keys) {
    json pairs = json::array();
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (std::size_t k = i + 1; k < keys.size(); ++k) pairs.push_back({{"required", {keys[i], keys[k]}}});
    return {{"anyOf", pairs}};
}

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

/// What a parameter of this type has, and has not, beside what all have.
json rules_of(ParamType type, bool column) {
    ParamSpec any;
    any.type = type;
    any.domain = {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    const bool has_unit = type == ParamType::curve ||
                          (is_block_type(type) && type != ParamType::bool_ && type != ParamType::enum_);
    if (has_unit) any.unit = schema::kAnyUnit;
    std::vector<std::string> absent;
    if (!has_unit) absent = {"unit", "min", "max", "ui"};
    if (type != ParamType::enum_) absent.push_back("values");
    if (!column) {
        if (type != ParamType::curve) absent.push_back("domain");
        if (type != ParamType::file) absent.insert(absent.end(), {"kind", "space"});
        if (type != ParamType::table) absent.push_back("columns");
        if (!is_block_type(type)) absent.insert(absent.end(), {"from"});
        if (type != ParamType::float_ && type != ParamType::int_ && type != ParamType::angle)
            absent.push_back("requires");
    }
    json rules = without(absent);
    rules["properties"]["default"] = schema::literal(any);
    if (!column) rules["properties"]["identity"] = schema::literal(any);
    if (!column && !is_block_type(type)) rules["properties"]["bind"] = {{"const", "uniform"}};
    const std::string of_enums = camera_sources(ParamType::enum_).front();
    if (!column && type == ParamType::enum_) rules["properties"]["from"] = {{"const", of_enums}};
    if (!column && is_block_type(type) && type != ParamType::enum_)
        rules["properties"]["from"] = {{"not", {{"const", of_enums}}}};
    if (type == ParamType::table) rules["required"] = {"columns"};
    else if (type == ParamType::enum_) rules["required"] = {"default", "values"};
    else if (type == ParamType::file) rules["required"] = {"default", "kind"};
    else rules["required"] = {"default"};
    return rules;
}

json param(bool column) {
    std::vector<std::string> types;
    json rules = json::array();
    for (const ParamType type :
         {ParamType::float_, ParamType::int_, ParamType::bool_, ParamType::enum_, ParamType::angle,
          ParamType::color, ParamType::vec2, ParamType::vec3, ParamType::vec4, ParamType::curve,
          ParamType::file, ParamType::table, ParamType::objects, ParamType::scattering_profile}) {
        if (column && !is_block_type(type)) continue;
        types.emplace_back(param_type_name(type));
        rules.push_back(where("type", types.back(), rules_of(type, column)));
    }
    json keys = {{"type", schema::one_of(types)},
                 {"doc", kText},
                 {"unit", schema::one_of(unit_names())},
                 {"default", json::object()},
                 {"min", kNumber},
                 {"max", kNumber},
                 {"ui", schema::array_of(kNumber, 2, 2)},
                 {"values", schema::array_of({{"type", "string"}, {"pattern", "^[a-z0-9_]+$"}}, 2)}};
    keys["values"]["uniqueItems"] = true;
    if (!column) {
        std::vector<std::string> sources = camera_sources(ParamType::enum_);
        for (std::string& source : camera_sources(ParamType::float_)) sources.push_back(std::move(source));
        keys["bind"] = schema::one_of({"uniform", "define"});
        keys["from"] = schema::one_of(sources);
        keys["identity"] = json::object();
        keys["requires"] =
            schema::array_of({{"type", "string"}, {"pattern", R"(^\s*(<|<=|>|>=)\s*[a-z][a-z0-9_]*\s*$)"}});
        keys["domain"] = schema::array_of(kNumber, 2, 2);
        keys["kind"] = schema::one_of({"image", "lut"});
        keys["space"] = schema::one_of({"srgb", "data"});
        keys["columns"] = schema::named(param(true));
        keys["columns"]["minProperties"] = 1;
        keys["columns"]["properties"] = without({"object", "objects", "name"})["properties"];
    }
    json result = schema::object(keys, {"type", "doc"});
    result["allOf"] = rules;
    return result;
}

json grid_scale() {
    return {{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", 4}};
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
                                  {"history", kFlag}},
                                 {"format", "doc"});
    result["not"] = at_most_one({"scale", "tile", "size"});
    return result;
}

json per() {
    return {{"anyOf",
             {{{"const", "pixel"}},
              schema::object({{"tile", count(2, 4096)}}, {"tile"}),
              schema::object({{"scale", grid_scale()}}, {"scale"})}}};
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

/// Of a texture's levels, or layers.
json level(int most) {
    const json of_turn = {{"type", "string"}, {"pattern", "^pass\\.index( *[-+] *[0-9]{1,2})?$"}};
    return schema::any_of({integer(0, most), of_turn});
}

json read() {
    const json filter = schema::one_of({"nearest", "linear"});
    const json options = schema::object({{"filter", filter},
                                         {"outside", schema::one_of({"clamp", "weight_zero"})},
                                         {"level", level(kMostLevel)}});
    const json chosen = {{"type", "object"},
                         {"additionalProperties", {{"anyOf", {filter, options}}}},
                         {"minProperties", 1},
                         {"maxProperties", 1}};
    return {{"anyOf", {kText, chosen}}};
}

json write() {
    const json options = schema::object({{"level", level(kMostLevel)}, {"layer", level(kMaxLayers - 1)}});
    const json chosen = {
        {"type", "object"}, {"additionalProperties", options}, {"minProperties", 1}, {"maxProperties", 1}};
    return {{"anyOf", {kText, chosen}}};
}

json instances() {
    json result = schema::object({{"of", schema::one_of({"quads", "points"})},
                                  {"count", count(1, 1 << 24)},
                                  {"per", per()},
                                  {"indirect", kName}},
                                 {"of"});
    result["oneOf"] = {{{"required", {"indirect"}}},
                       {{"anyOf", {{{"required", {"count"}}}, {{"required", {"per"}}}}}}};
    return result;
}

json dispatch() {
    const json groups = schema::array_of(integer(1, 65535), 3, 3);
    return schema::any_of({schema::object({{"tile", count(1, 4096)}, {"over", kText}}, {"tile"}),
                           schema::object({{"groups", groups}}, {"groups"}),
                           schema::object({{"indirect", kText}}, {"indirect"})});
}

/// What the kinds of passes have, and have not.
json rules_of_kinds() {
    json compute = without({"writes", "vertex", "instances", "blend", "value"});
    compute["required"] = {"shader", "dispatch"};
    json clear = without({"shader", "vertex", "reads", "images", "buffers", "defines", "repeat",
                          "max_iterations", "instances", "dispatch", "blend"});
    clear["required"] = {"writes", "value"};
    json draw = without({"dispatch", "value"});
    draw["required"] = {"shader", "writes"};
    draw["dependentRequired"] = {{"vertex", {"instances"}}, {"instances", {"vertex"}}};
    json draws = where("kind", "draw", draw);
    draws["if"].erase("required");  // the kind of a pass that names none
    return {where("kind", "compute", compute), where("kind", "clear", clear), draws};
}

json when() {
    const json value = {{"type", {"boolean", "integer", "string"}}};
    return {{"type", "object"},
            {"patternProperties", {{"^has\\.", schema::any_of({kFlag, schema::array_of(kFlag, 1)})}}},
            {"additionalProperties", schema::any_of({value, schema::array_of(value, 1)})}};
}

json pass() {
    const json access = {{"type", "object"},
                         {"additionalProperties", schema::one_of({"read", "write", "atomic"})}};
    // As GLSL names macros.
    const json defines = {{"type", "object"},
                          {"propertyNames", {{"pattern", "^(?!GL_)(?!.*__)[A-Za-z_][A-Za-z0-9_]*$"}}},
                          {"additionalProperties", {{"type", {"string", "integer"}}}}};
    json result = schema::object({{"name", schema::snake_case()},
                                  {"kind", schema::one_of({"draw", "compute", "clear"})},
                                  {"shader", kText},
                                  {"vertex", kName},
                                  {"reads", schema::array_of(read())},
                                  {"writes", schema::array_of(write(), 1)},
                                  {"images", access},
                                  {"buffers", access},
                                  {"defines", defines},
                                  {"when", when()},
                                  {"repeat", count(1, kMaxRepeat)},
                                  {"max_iterations", integer(1, kMaxIterations)},
                                  {"instances", instances()},
                                  {"dispatch", dispatch()},
                                  {"blend", schema::one_of({"add", "min", "max"})},
                                  {"value", texel()}},
                                 {"name"});
    result["allOf"] = rules_of_kinds();
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
    const json channel = {{"type", "string"}, {"pattern", "^[a-z][a-z0-9_]*\\.[rgba]$"}};
    const json number_node = {{"type", "number"}};
    const json statistic = schema::object({{"of", channel},
                                           {"where", channel},
                                           {"squared", kFlag},
                                           {"bins", schema::array_of(number_node, 3, 3)},
                                           {"doc", kText}},
                                          {"of"});
    json modules = schema::array_of(schema::snake_case());
    modules["uniqueItems"] = true;
    return schema::document("Aftershade effect",
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
                             {"passes", schema::array_of(pass(), 1)},
                             {"native", native()},
                             {"telemetry", schema::named(statistic)},
                             {"presets", presets}},
                            {"id", "version", "summary", "inputs", "outputs", "passes"})
               .dump(2) +
           "\n";
}

std::string module_schema() {
    return schema::document("Aftershade module",
                            {{"module", schema::snake_case()},
                             {"summary", kText},
                             {"uses", uses()},
                             {"params", schema::named(param(false))},
                             {"textures", schema::named(texture())},
                             {"buffers", schema::named(buffer())},
                             {"passes", schema::array_of(pass())}},
                            {"module", "summary"})
               .dump(2) +
           "\n";
}

}  // namespace aftershade
