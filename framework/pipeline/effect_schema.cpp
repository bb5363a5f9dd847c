#include "framework/core/units.h"
#include "framework/effect/manifest.h"
#include "framework/image/camera.h"
#include "framework/image/role.h"
#include "framework/pipeline/schema.h"
#include "framework/pipeline/schema_common.h"

namespace aftershade {

using schema::json;

namespace {

const json kText = {{"type", "string"}};
const json kFlag = {{"type", "boolean"}};
const json kNumber = {{"type", "number"}};

/// Members of any snake_case name, each as `value`.
json named(const json& value) {
    return {{"type", "object"},
            {"propertyNames", {{"pattern", schema::kSnakeCase}}},
            {"additionalProperties", value}};
}

json integer(int min, int max) {
    return {{"type", "integer"}, {"minimum", min}, {"maximum", max}};
}

/// A number, or the name of an int parameter.
json count(int min, int max) {
    return {{"anyOf", {integer(min, max), {{"type", "string"}, {"pattern", schema::kSnakeCase}}}}};
}

json role() {
    std::vector<std::string> roles;
    for (const ChannelRole& known : channel_roles()) roles.push_back(known.name);
    return {{"anyOf", {schema::one_of(roles), {{"type", "string"}, {"pattern", "^aov:.+$"}}}}};
}

json numbers(int min, int max) {
    return {{"anyOf", {kNumber, schema::array_of(kNumber, min, max)}}};
}

json param(bool column) {
    std::vector<std::string> types = {"float", "int",  "bool", "enum", "angle",
                                      "color", "vec2", "vec3", "vec4"};
    if (!column) types.insert(types.end(), {"curve", "file", "table"});
    json keys = {{"type", schema::one_of(types)},
                 {"doc", {{"type", "string"}, {"minLength", 1}}},
                 {"unit", schema::one_of(unit_names())},
                 {"default", json::object()},
                 {"min", kNumber},
                 {"max", kNumber},
                 {"ui", schema::array_of(kNumber, 2, 2)},
                 {"values", schema::array_of({{"type", "string"}, {"pattern", "^[a-z0-9_]+$"}}, 2)}};
    if (!column) {
        std::vector<std::string> sources{"camera.lens_model"};
        for (const CameraField& field : camera_fields()) sources.push_back("camera." + field.name);
        keys["bind"] = schema::one_of({"uniform", "define"});
        keys["from"] = schema::one_of(sources);
        keys["identity"] = json::object();
        keys["requires"] =
            schema::array_of({{"type", "string"}, {"pattern", "^\\s*(<|<=|>|>=)\\s*[a-z][a-z0-9_]*\\s*$"}});
        keys["domain"] = schema::array_of(kNumber, 2, 2);
        keys["kind"] = schema::one_of({"image", "lut"});
        keys["space"] = schema::one_of({"srgb", "data"});
        keys["columns"] = named(param(true));
    }
    json result = schema::object(keys, {"type", "doc"});
    // A table's default is its columns'.
    result["if"] = {{"properties", {{"type", {{"const", "table"}}}}}};
    result["then"] = column ? json(json::object()) : json{{"required", {"columns"}}};
    result["else"] = {{"required", {"default"}}};
    return result;
}

json texture() {
    std::vector<std::string> formats;
    for (const auto name : gpu::texture_format_names()) formats.emplace_back(name);
    return schema::object({{"format", schema::one_of(formats)},
                           {"doc", kText},
                           {"scale", {{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", 4}}},
                           {"tile", count(2, 4096)},
                           {"size", schema::array_of(integer(1, kMaxSide), 2, 2)},
                           {"layers", integer(1, kMaxLayers)},
                           {"mips", {{"anyOf", {{{"const", "auto"}}, integer(1, 15)}}}},
                           {"clear", numbers(4, 4)},
                           {"history", kFlag}},
                          {"format", "doc"});
}

json per() {
    return {{"anyOf",
             {{{"const", "pixel"}},
              schema::object({{"tile", count(2, 4096)}}, {"tile"}),
              schema::object({{"scale", kNumber}}, {"scale"})}}};
}

json buffer() {
    return schema::object({{"element", schema::one_of({"float", "int", "uint", "vec2", "vec4", "ivec2",
                                                       "ivec4", "uvec2", "uvec4"})},
                           {"doc", kText},
                           {"count", count(1, 1 << 30)},
                           {"per", per()},
                           {"clear", numbers(1, 65536)},
                           {"history", kFlag},
                           {"indirect", kFlag}},
                          {"element", "doc"});
}

json level() {
    return {{"anyOf",
             {integer(0, kMaxLayers), {{"type", "string"}, {"pattern", "^pass\\.index( *[-+] *[0-9]+)?$"}}}}};
}

json read() {
    const json filter = schema::one_of({"nearest", "linear"});
    const json options = schema::object(
        {{"filter", filter}, {"outside", schema::one_of({"clamp", "weight_zero"})}, {"level", level()}});
    const json chosen = {{"type", "object"},
                         {"additionalProperties", {{"anyOf", {filter, options}}}},
                         {"minProperties", 1},
                         {"maxProperties", 1}};
    return {{"anyOf", {kText, chosen}}};
}

json write() {
    const json options = schema::object({{"level", level()}, {"layer", level()}});
    const json chosen = {
        {"type", "object"}, {"additionalProperties", options}, {"minProperties", 1}, {"maxProperties", 1}};
    return {{"anyOf", {kText, chosen}}};
}

json pass() {
    const json value = {{"type", {"boolean", "integer", "string"}}};
    const json access = {{"type", "object"},
                         {"additionalProperties", schema::one_of({"read", "write", "atomic"})}};
    const json dispatch = {
        {"anyOf",
         {schema::object({{"tile", count(1, 1024)}, {"over", kText}}, {"tile"}),
          schema::object({{"groups", schema::array_of(integer(1, 65535), 3, 3)}}, {"groups"}),
          schema::object({{"indirect", kText}}, {"indirect"})}}};
    return schema::object(
        {{"name", {{"type", "string"}, {"pattern", schema::kSnakeCase}}},
         {"kind", schema::one_of({"draw", "compute", "clear"})},
         {"shader", kText},
         {"vertex", kText},
         {"reads", schema::array_of(read())},
         {"writes", schema::array_of(write())},
         {"images", access},
         {"buffers", access},
         {"defines", {{"type", "object"}, {"additionalProperties", {{"type", {"string", "integer"}}}}}},
         {"when",
          {{"type", "object"}, {"additionalProperties", {{"anyOf", {value, schema::array_of(value, 1)}}}}}},
         {"repeat", count(1, kMaxRepeat)},
         {"max_iterations", integer(1, kMaxIterations)},
         {"instances", schema::object({{"of", schema::one_of({"quads", "points"})},
                                       {"count", count(1, 1 << 30)},
                                       {"per", per()},
                                       {"indirect", kText}},
                                      {})},
         {"dispatch", dispatch},
         {"blend", schema::one_of({"add", "min", "max"})},
         {"value", numbers(4, 4)}},
        {"name"});
}

json native() {
    const json side = integer(1, 1024);
    return schema::object(
        {{"uniforms",
          named(schema::object(
              {{"type", schema::one_of({"float", "int", "uint", "vec2", "vec3", "vec4"})}, {"doc", kText}},
              {"type", "doc"}))},
         {"tables", named(schema::object(
                        {{"element", schema::one_of({"float", "vec2", "vec4", "uint", "uvec2", "uvec4"})},
                         {"count", {{"anyOf", {side, schema::array_of(side, 2, 2)}}}},
                         {"doc", kText}},
                        {"element", "count", "doc"}))}});
}

}  // namespace

std::string effect_schema() {
    const json input = schema::object({{"role", role()},
                                       {"optional", kFlag},
                                       {"history", kFlag},
                                       {"frame", schema::json{{"enum", {-1, 1}}}},
                                       {"doc", kText}},
                                      {"role"});
    const json output = schema::object({{"role", role()}, {"doc", kText}}, {"role"});
    json outputs = named(output);
    outputs["minProperties"] = 1;
    return schema::document(
               "Aftershade effect",
               {{"id", {{"type", "string"}, {"pattern", schema::kSnakeCase}}},
                {"version", {{"type", "string"}, {"pattern", "^[0-9]+\\.[0-9]+\\.[0-9]+$"}}},
                {"summary", kText},
                {"sources", schema::array_of(kText)},
                {"accumulates", schema::json{{"const", "subframes"}}},
                {"inputs", named(input)},
                {"outputs", outputs},
                {"params", named(param(false))},
                {"textures", named(texture())},
                {"buffers", named(buffer())},
                {"passes", schema::array_of(pass(), 1)},
                {"native", native()},
                {"presets", {{"type", "object"}, {"additionalProperties", {{"type", "object"}}}}}},
               {"id", "version", "summary", "inputs", "outputs", "passes"})
               .dump(2) +
           "\n";
}

}  // namespace aftershade
