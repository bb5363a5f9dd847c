#include <utility>

#include "framework/core/param_type.h"
#include "framework/core/units.h"
#include "framework/effect/describe.h"
#include "framework/image/camera.h"
#include "framework/image/role.h"
#include "framework/pipeline/look.h"
#include "framework/pipeline/pipeline.h"
#include "framework/pipeline/schema.h"
#include "framework/pipeline/schema_role.h"

namespace aftershade {

using schema::json;

namespace {

/// {"var": "name"} may stand for every part of a value.
json or_variable(json form) {
    return schema::any_of({std::move(form), schema::variable()});
}

/// {"keys": {"1": 2.0, "24": 5.6}}
json keyed(const json& literal) {
    json keys = {{"type", "object"},
                 {"patternProperties", {{"^-?[0-9]+$", literal}}},
                 {"additionalProperties", false},
                 {"minProperties", 1}};
    return schema::object({{"keys", or_variable(keys)},
                           {"interpolation", or_variable(schema::one_of({"linear", "smooth", "step"}))}},
                          {"keys"});
}

/// Values of the capture that a parameter may take.
std::vector<json> captured(const ParamSpec& spec) {
    std::vector<json> forms;
    std::vector<std::string> fields;
    if (spec.type->is_choice) fields = camera_sources(spec.type);
    if (is_scalar_type(spec.type))
        for (const CameraField& field : camera_fields())
            if (converts_to(field, spec)) fields.push_back(std::string(kFromCamera) + field.name);
    if (!fields.empty())
        forms.push_back(schema::object({{"from", or_variable(schema::one_of(fields))}}, {"from"}));
    if (!is_scalar_type(spec.type) || !convert_unit(1, "m", spec.unit)) return forms;
    const json depth = or_variable({{"const", "depth"}});
    const json side = or_variable({{"type", "number"}, {"minimum", 0}, {"maximum", 1}});
    const json point = or_variable(schema::array_of(side, 2, 2));
    forms.push_back(schema::object({{"from", depth}, {"uv", point}}, {"from", "uv"}));
    forms.push_back(
        schema::object({{"from", depth}, {"object", or_variable(schema::object_key())}}, {"from", "object"}));
    return forms;
}

/// A value in any form, with what the manifest says of it.
json value_of(const ParamSpec& spec) {
    const json literal = schema::literal(spec, schema::Variables::yes);
    json forms = {literal};
    if (spec.bind != ParamBind::define) forms.push_back(keyed(literal));
    for (json& form : captured(spec)) forms.push_back(std::move(form));
    const std::string range = range_text(spec);
    json value = {
        {"description", spec.doc + " [" + type_text(spec) + (range.empty() ? "" : ", " + range) + "]"}};
    if (spec.type->has_default) value["default"] = json::parse(format_value(spec, spec.default_value));
    value["anyOf"] = std::move(forms);
    return value;
}

json wiring_of(const EffectManifest& effect) {
    json inputs = json::object();
    for (const InputSpec& input : effect.inputs)
        inputs[input.name] = {
            {"type", "string"},
            {"pattern", "^([a-z][a-z0-9_]*\\.[a-z][a-z0-9_]*|capture\\.aov:.+)$"},
            {"description", "capture.<role>, <step>.<output> or <step>.<texture>; takes the role " +
                                input.role + ". " + input.doc}};
    return schema::object(inputs);
}

json mask() {
    const json object = or_variable(schema::object_key());
    const json objects = schema::array_of(object, 1, int(kMaxMaskObjects));
    json result = schema::object({{"role", or_variable(schema::role())},
                                  {"object", schema::any_of({object, objects})},
                                  {"file", or_variable({{"type", "string"}, {"minLength", 1}})},
                                  {"invert", or_variable({{"type", "boolean"}})}});
    result["oneOf"] = {{{"required", {"role"}}}, {{"required", {"object"}}}, {{"required", {"file"}}}};
    result["description"] = "Where the step works: a role of one channel, objects, or a picture.";
    return result;
}

json step_of(const EffectManifest& effect) {
    json params = json::object();
    for (const ParamSpec& spec : effect.params) params[spec.name] = value_of(spec);
    json properties = {
        {"effect", {{"const", effect.id}, {"description", effect.summary}}},
        {"name", {{"type", "string"}, {"pattern", schema::kSnakeCase}, {"not", {{"const", "capture"}}}}},
        {"enabled", {{"type", "boolean"}}}};
    std::vector<std::string> presets;
    for (const PresetSpec& preset : effect.presets) presets.push_back(preset.name);
    // An effect without presets takes none.
    if (!presets.empty()) properties["preset"] = schema::one_of(presets);
    properties["params"] = schema::object(params);
    properties["in"] = wiring_of(effect);
    properties["mix"] = value_of(mix_spec());
    properties["mask"] = {{"$ref", "#/$defs/Mask"}};
    return schema::object(properties, {"effect"});
}

json use() {
    return schema::object(
        {{"use", {{"type", "string"}, {"description", "Another look, named from this one's folder."}}},
         {"name", {{"type", "string"}, {"pattern", schema::kSnakeCase}}},
         {"enabled", {{"type", "boolean"}}},
         {"vars", {{"type", "object"}}}},
        {"use"});
}

}  // namespace

std::string look_schema(const std::vector<const EffectManifest*>& effects) {
    json branches = json::array({use()});
    json definitions = {{"Mask", mask()}};
    schema::define_variable(definitions);
    for (const EffectManifest* effect : effects) {
        definitions[effect->id] = step_of(*effect);
        branches.push_back({{"$ref", "#/$defs/" + effect->id}});
    }
    const json variables = {{"type", "object"},
                            {"propertyNames", {{"pattern", schema::kSnakeCase}}},
                            {"description", "Values by name, put in where {\"var\": \"name\"} stands."}};
    json document = schema::document("Aftershade look",
                                     {{"summary", schema::text()},
                                      {"vars", variables},
                                      {"steps", schema::array_of({{"oneOf", branches}})}},
                                     {"steps"});
    document["$defs"] = std::move(definitions);
    return document.dump(2) + "\n";
}

}  // namespace aftershade
