#include "framework/pipeline/pass_schema.h"

#include <utility>

#include "framework/effect/manifest/manifest.h"

namespace aftershade::schema_of_effect {

json integer(int min, int max) {
    return {{"type", "integer"}, {"minimum", min}, {"maximum", max}};
}

json count(int min, int max) {
    return {{"anyOf", {integer(min, max), schema::snake_case()}}};
}

json texel() {
    return schema::any_of({kNumber, schema::array_of(kNumber, 1, 1), schema::array_of(kNumber, 4, 4)});
}

json at_most_one(const std::vector<std::string>& keys) {
    json pairs = json::array();
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (std::size_t k = i + 1; k < keys.size(); ++k) pairs.push_back({{"required", {keys[i], keys[k]}}});
    return {{"anyOf", pairs}};
}

json where(const std::string& key, const std::string& value, json then) {
    return {{"if", {{"properties", {{key, {{"const", value}}}}}, {"required", {key}}}},
            {"then", std::move(then)}};
}

json without(const std::vector<std::string>& keys) {
    json properties = json::object();
    for (const std::string& key : keys) properties[key] = false;
    return {{"properties", properties}};
}

json when() {
    const json value = {{"type", {"boolean", "integer", "string"}}};
    return {{"type", "object"},
            {"patternProperties", {{"^has\\.", schema::any_of({kFlag, schema::array_of(kFlag, 1)})}}},
            {"additionalProperties", schema::any_of({value, schema::array_of(value, 1)})}};
}

json channel() {
    return {{"type", "string"}, {"pattern", "^[a-z][a-z0-9_]*\\.[rgba]$"}};
}

json grid_scale() {
    return {{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", 4}};
}

json per() {
    return {{"anyOf",
             {{{"const", "pixel"}},
              schema::object({{"tile", count(2, 4096)}}, {"tile"}),
              schema::object({{"scale", grid_scale()}}, {"scale"})}}};
}

namespace {

constexpr int kMostLevel = 14;  // of 16384 texels a side

/// Of a texture's levels, or layers.
json level(int most) {
    const json of_turn = {{"type", "string"}, {"pattern", "^pass\\.index( *[-+] *[0-9]{1,2})?$"}};
    return schema::any_of({integer(0, most), of_turn});
}

json read() {
    const json filter = schema::one_of({"nearest", "linear"});
    const json options = schema::object({{"filter", filter},
                                         {"outside", schema::one_of({"clamp", "weight_zero"})},
                                         {"level", level(kMostLevel)},
                                         {"when", when()}});
    const json chosen = {{"type", "object"},
                         {"additionalProperties", {{"anyOf", {filter, options}}}},
                         {"minProperties", 1},
                         {"maxProperties", 1}};
    return {{"anyOf", {kText, chosen}}};
}

json write() {
    const json options = schema::object(
        {{"level", level(kMostLevel)}, {"layer", level(kMaxLayers - 1)}, {"when", when()}});
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
    json compute = without({"writes", "vertex", "instances", "over", "blend", "value"});
    compute["required"] = {"shader", "dispatch"};
    json clear = without({"shader", "vertex", "reads", "images", "buffers", "defines", "repeat",
                          "max_iterations", "instances", "over", "dispatch", "blend"});
    clear["required"] = {"writes", "value"};
    json draw = without({"dispatch", "value"});
    draw["required"] = {"shader"};
    draw["dependentRequired"] = {{"instances", {"vertex"}}};
    draw["dependentSchemas"]["vertex"] = {
        {"anyOf", {{{"required", {"instances"}}}, {{"required", {"over"}}}}}};
    draw["not"] = at_most_one({"instances", "over"});
    json draws = where("kind", "draw", draw);
    draws["if"].erase("required");  // the kind of a pass that names none
    return {where("kind", "compute", compute), where("kind", "clear", clear), draws};
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
                                  {"over", kName},
                                  {"dispatch", dispatch()},
                                  {"blend", schema::one_of({"add", "min", "max"})},
                                  {"value", texel()}},
                                 {"name"});
    result["allOf"] = rules_of_kinds();
    return result;
}

/// Passes that share conditions.
json group() {
    return schema::object({{"when", when()}, {"passes", passes(1)}}, {"when", "passes"});
}

}  // namespace

json passes(int least) {
    const json item = {{"if", {{"type", "object"}, {"required", {"passes"}}}},
                       {"then", {{"$ref", "#/$defs/group"}}},
                       {"else", {{"$ref", "#/$defs/pass"}}}};
    return schema::array_of(item, least);
}

void define_passes(json& document) {
    document["$defs"]["pass"] = pass();
    document["$defs"]["group"] = group();
}

json tile_list() {
    json result = schema::object({{"of", channel()},
                                  {"predicate", kName},
                                  {"tile", integer(2, 256)},
                                  {"on", kText},
                                  {"reads", schema::array_of(read())},
                                  {"when", when()},
                                  {"doc", kText}},
                                 {"doc"});
    json of_texture = without({"predicate", "tile", "on", "reads"}), by_predicate = without({"of"});
    of_texture["required"] = {"of"};
    by_predicate["required"] = {"predicate", "tile"};
    result["oneOf"] = {of_texture, by_predicate};
    return result;
}

}  // namespace aftershade::schema_of_effect
