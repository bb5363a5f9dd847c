#include <nlohmann/json.hpp>

#include "framework/document/param_type.h"
#include "framework/effect/description.h"

namespace aftershade {

using json = nlohmann::ordered_json;

namespace {

json value_json(const ParamSpec& spec, const ParamValue& value) {
    return json::parse(format_value(spec, value));
}

json param_json(const ParamSpec& spec) {
    json entry = {{"type", param_type_name(spec.type)}, {"doc", spec.doc}};
    if (!spec.unit.empty()) entry["unit"] = spec.unit;
    if (!spec.values.empty()) entry["values"] = spec.values;
    if (spec.type->has_default) entry["default"] = value_json(spec, spec.default_value);
    if (spec.min) entry["min"] = *spec.min;
    if (spec.max) entry["max"] = *spec.max;
    if (spec.ui_range) entry["ui"] = *spec.ui_range;
    if (spec.identity) entry["identity"] = value_json(spec, *spec.identity);
    if (!spec.from.empty()) entry["from"] = spec.from;
    if (!spec.section.empty()) entry["section"] = spec.section;
    if (spec.is_advanced) entry["advanced"] = true;
    if (is_block_type(spec.type)) entry["bind"] = spec.bind == ParamBind::define ? "define" : "uniform";
    entry.update(spec.type->describe(spec));
    if (!spec.type->has_columns) return entry;
    for (const ParamSpec& column : spec.columns) entry["columns"][column.name] = param_json(column);
    return entry;
}

}  // namespace

std::string describe_json(const EffectManifest& manifest) {
    json result = {{"id", manifest.id},           {"version", manifest.version},
                   {"summary", manifest.summary}, {"sources", manifest.sources},
                   {"inputs", json::object()},    {"outputs", json::object()},
                   {"params", json::object()},    {"textures", json::object()},
                   {"passes", json::array()},     {"presets", json::object()}};
    if (!manifest.group.empty()) result["group"] = manifest.group;
    if (manifest.is_recommended) result["recommended"] = true;
    if (manifest.uses_lights) result["uses"] = {"lights"};
    for (const InputSpec& input : manifest.inputs) {
        json entry = {{"role", input.role}, {"optional", input.optional}, {"doc", input.doc}};
        if (input.history) entry["history"] = true;
        if (input.frame != 0) entry["frame"] = input.frame;
        if (input.layer >= 0) entry["layer"] = input.layer;
        if (input.from_capture) entry["from"] = "capture";
        if (!input.instead.empty()) entry["instead"] = input.instead;
        result["inputs"][input.name] = entry;
    }
    for (const OutputSpec& output : manifest.outputs)
        result["outputs"][output.name] = {{"role", output.role}, {"doc", output.doc}};
    for (const ParamSpec& spec : manifest.params) result["params"][spec.name] = param_json(spec);
    for (const TextureSpec& texture : manifest.textures)
        result["textures"][texture.name] = {{"format", gpu::texture_format_name(texture.format)},
                                            {"history", texture.history},
                                            {"doc", texture.doc}};
    for (const TelemetrySpec& spec : manifest.telemetry)
        result["telemetry"][spec.name] = {{"of", spec.of.text()}, {"doc", spec.doc}};
    for (const TileListSpec& list : manifest.tiles) result["tiles"][list.name] = {{"doc", list.doc}};
    for (const PassSpec& pass : manifest.passes) {
        json entry = {{"name", pass.name}, {"shader", pass.shader}, {"module", pass.module}};
        if (pass.over()) entry["over"] = *pass.over();
        if (pass.lists()) entry["lists"] = *pass.lists();
        result["passes"].push_back(entry);
    }
    for (const PresetSpec& preset : manifest.presets) {
        json& values = result["presets"][preset.name] = json::object();
        for (const auto& [name, value] : preset.values)
            values[name] = value_json(*manifest.find_param(name), value);
    }
    return result.dump(2);
}

}  // namespace aftershade
