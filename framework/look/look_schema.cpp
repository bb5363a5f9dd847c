#include <nlohmann/json.hpp>
#include <utility>

#include "framework/document/grammar_schema.h"
#include "framework/document/param_type.h"
#include "framework/document/schema_pieces.h"
#include "framework/document/units.h"
#include "framework/effect/description.h"
#include "framework/image/camera.h"
#include "framework/look/ease.h"
#include "framework/look/look_grammar.h"
#include "framework/look/look_schema.h"
#include "framework/look/pipeline.h"

namespace aftershade {

using Json = schema::json;

namespace {

/// {"var": "name"} may stand for every part of a value.
Json or_variable(Json form) {
    return schema::any_of({std::move(form), schema::variable()});
}

/// How values go from one key to the next.
Json ease() {
    const Json handle = or_variable({{"type", "number"}, {"minimum", 0}, {"maximum", 1}});
    return or_variable(schema::any_of({schema::one_of(ease_names()), schema::array_of(handle, 4, 4)}));
}

/// {"keys": {"1": 2.0, "24": {"value": 5.6, "interpolation": "smooth"}}}; `value` is of one key.
Json keyed(const Json& value) {
    Json key = {{"anyOf", {value, schema::object({{"value", value}, {"interpolation", ease()}}, {"value"})}}};
    Json keys = {{"type", "object"},
                 {"patternProperties", {{"^-?[0-9]+$", std::move(key)}}},
                 {"additionalProperties", false},
                 {"minProperties", 1}};
    return schema::object({{"keys", or_variable(keys)}, {"interpolation", ease()}}, {"keys"});
}

/// {"from": "depth", "uv": [0.5, 0.5]} and {"from": "depth", "object": "Wheel"}
void add_forms_of_pixels(const char* name, std::vector<Json>& forms) {
    const Json source = or_variable({{"const", name}});
    const Json side = or_variable({{"type", "number"}, {"minimum", 0}, {"maximum", 1}});
    const Json point = or_variable(schema::array_of(side, 2, 2));
    forms.push_back(schema::object({{"from", source}, {"uv", point}}, {"from", "uv"}));
    forms.push_back(schema::object({{"from", source}, {"object", or_variable(schema::object_key())}},
                                   {"from", "object"}));
}

/// Values of the capture that a parameter may take.
std::vector<Json> captured(const ParamSpec& spec) {
    std::vector<Json> forms;
    std::vector<std::string> fields;
    if (spec.type->is_choice) fields = camera_sources(spec.type);
    if (is_scalar_type(spec.type))
        for (const CameraField& field : camera_fields())
            if (converts_to(field, spec)) fields.push_back(std::string(kFromCamera) + field.name);
    if (!fields.empty())
        forms.push_back(schema::object({{"from", or_variable(schema::one_of(fields))}}, {"from"}));
    if (!is_scalar_type(spec.type)) return forms;
    for (const auto& [source, unit] : {std::pair("depth", "m"), {"luminance", "ev"}})
        if (convert_unit(1, unit, spec.unit)) add_forms_of_pixels(source, forms);
    return forms;
}

/// A value in any form.
Json value_of(const ParamSpec& spec) {
    Json forms = {schema::literal(spec, schema::Variables::yes)};
    for (Json& form : captured(spec)) forms.push_back(std::move(form));
    if (spec.bind != ParamBind::define)
        forms.push_back(keyed(forms.size() == 1 ? forms[0] : Json{{"anyOf", forms}}));
    return {{"anyOf", std::move(forms)}};
}

grammar::Form form_of(const Json& schema) {
    return grammar::custom({.type = "", .schema = schema.dump()});
}

/// A value in any form, with what the manifest says of it.
grammar::Key value_key(const ParamSpec& spec) {
    const std::string range = range_text(spec);
    return grammar::optional(spec.name, form_of(value_of(spec)),
                             spec.doc + " [" + type_text(spec) + (range.empty() ? "" : ", " + range) + "]",
                             spec.type->has_default ? format_value(spec, spec.default_value) : "");
}

grammar::Form params_of(const EffectManifest& effect) {
    grammar::Block block;
    for (const ParamSpec& spec : effect.params) block.keys.push_back(value_key(spec));
    return grammar::object(std::move(block));
}

grammar::Form wiring_of(const EffectManifest& effect) {
    grammar::Block block;
    for (const InputSpec& input : effect.inputs)
        block.keys.push_back(
            grammar::optional(input.name, look_wire(),
                              "capture.<role>, <step>.<output> or <step>.<texture>; takes the role " +
                                  input.role + ". " + input.doc));
    return grammar::object(std::move(block));
}

/// The step's block, with what the effect's manifest says of its keys.
grammar::Block step_of(const EffectManifest& effect) {
    grammar::Block block = look_step_block();
    block.definition = effect.id;
    block.doc = effect.summary;
    std::vector<std::string> presets;
    for (const PresetSpec& preset : effect.presets) presets.push_back(preset.name);
    // An effect without presets takes none.
    const auto take_out = [&](const std::string& name) {
        std::erase_if(block.keys, [&](const grammar::Key& key) { return key.name == name; });
    };
    if (presets.empty()) take_out("preset");
    if (!is_isf_path(effect.document)) take_out("space");
    for (grammar::Key& key : block.keys) {
        if (key.name == "effect")
            key = grammar::required("effect", grammar::choice({effect.id}), effect.summary);
        if (key.name == "preset") key.form = grammar::choice(presets);
        if (key.name == "params") key.form = params_of(effect);
        if (key.name == "in") key.form = wiring_of(effect);
        if (key.name == "mix") key = value_key(mix_spec());
    }
    return block;
}

/// A step of an ISF file that no manifest is known of.
grammar::Block step_of_isf() {
    grammar::Block block = look_step_block();
    block.definition = "isf_file";
    block.doc = "An ISF file, by its path.";
    std::erase_if(block.keys, [](const grammar::Key& key) { return key.name == "preset"; });
    for (grammar::Key& key : block.keys)
        if (key.name == "effect")
            key = grammar::required(
                "effect",
                grammar::text({.pattern = {R"(\.[fF][sS]$)",
                                           [](const std::string& path) { return is_isf_path(path); }}}),
                "Path from the look's folder.");
    return block;
}

}  // namespace

std::string look_schema(const std::vector<const EffectManifest*>& effects) {
    std::vector<grammar::Form> steps;
    for (const EffectManifest* effect : effects) steps.push_back(grammar::object(step_of(*effect)));
    steps.push_back(grammar::object(step_of_isf()));
    grammar::Block look = look_block();
    for (grammar::Key& key : look.keys)
        if (key.name == "steps")
            key.form = grammar::list(
                grammar::by_key("use", grammar::object(look_use_block()), grammar::any_of(steps)));
    return grammar::schema_text("Aftershade look", look);
}

}  // namespace aftershade
