#include "framework/effect/manifest/manifest_reader.h"

#include <algorithm>
#include <utility>

#include "framework/document/units.h"
#include "framework/effect/manifest/manifest_check.h"
#include "framework/effect/manifest/manifest_expand.h"
#include "framework/effect/manifest/manifest_grammar.h"
#include "framework/effect/manifest/manifest_groups.h"
#include "framework/effect/manifest/manifest_parser.h"
#include "framework/effect/manifest/manifest_when.h"
#include "framework/effect/param_types.h"

namespace aftershade {

namespace fs = std::filesystem;

void ManifestParser::identity(const Reader& document) {
    const Node* id = document.node().find("id");
    manifest_.id = document.text("id");
    const std::string folder = manifest_.folder.filename().string();
    const bool has_folder = manifest_.document == manifest_.folder / "effect.json";
    if (has_folder && id && id->is_string() && id->string != folder)
        fault(id->place, "the id '" + id->string + "' is not the name of its folder, '" + folder + "'");
    manifest_.version = document.text("version");
    manifest_.summary = document.text("summary");
    if (document.has("group")) manifest_.group = document.text("group");
    manifest_.is_recommended = document.boolean("recommended");
    manifest_.sources = document.texts("sources");
    manifest_.accumulates_subframes = document.has("accumulates");
    enum class Part { data, display };
    manifest_.is_in_display_window = document.choice<Part>("window") == Part::display;
    if (const auto warmup = document.object("warmup"))
        manifest_.warmup = {int(warmup->integer("frames")), warmup->number("error")};
}

void ManifestParser::reach(const Reader& document) {
    const Node* node = document.find("reach");
    if (!node) return;
    ReachSpec reach;
    reach.place = node->place;
    reach.is_all = node->is_string();
    const auto add = [&](const Node& part) {
        if (part.is_number()) {
            reach.px += int(part.number);
            return;
        }
        // "10 * radius" counts ten times.
        const std::size_t sign = part.string.find(" * ");
        const auto factor = sign < 3 ? parse_number(part.string.substr(0, sign)) : std::nullopt;
        const bool is_factor = factor && *factor >= 1 &&
                               part.string.find_first_not_of("0123456789") == sign && part.string[0] != '0';
        const std::string name = is_factor ? part.string.substr(sign + 3) : part.string;
        const ParamSpec* const spec = manifest_.find_param(name);
        if (!spec && !faulty_params_.contains(name))
            fault(part.place, "'reach' names '" + name + "', which is not a parameter" +
                                  did_you_mean(name, manifest_.param_names()));
        else if (spec && (spec->unit != "px" || !spec->max))
            fault(part.place, "'reach' names '" + name + "', which is not a parameter in px with a max");
        reach.params.insert(reach.params.end(), is_factor ? std::size_t(*factor) : 1, name);
    };
    if (node->is_array()) std::ranges::for_each(node->items, add);
    else if (!reach.is_all) add(*node);
    manifest_.reach = std::move(reach);
}

void ManifestParser::uses(const Reader& document) {
    if (const Node* names = document.find("uses"))
        for (const Node& item : names->items)
            if (item.string == "lights" && !manifest_.uses_lights) manifest_.uses_lights = item.place;
}

void ManifestParser::params(const Reader& document) {
    const Node* section = document.find("params");
    if (!section) return;
    for (const Member& member : section->members) {
        if (!is_new("parameter", member)) continue;
        // The check of the whole document has reported its faults.
        Diagnostics faults;
        const bool is_sound = grammar::check(member.value, manifest_param_block(), faults);
        auto spec =
            is_sound ? read_param_spec(member.key, member.value, diagnostics_, param_types()) : std::nullopt;
        if (spec) manifest_.params.push_back(std::move(*spec));
        else faulty_params_.insert(member.key);
    }
}

void ManifestParser::presets(const Reader& document) {
    if (const Node* section = document.find("presets"))
        for (const Member& member : section->members) preset(member);
}

void ManifestParser::preset(const Member& member) {
    PresetSpec preset;
    preset.name = member.key;
    for (const Member& value : member.value.members) {
        if (faulty_params_.contains(value.key)) continue;
        const ParamSpec* spec = manifest_.find_param(value.key);
        if (!spec) {
            fault(value.key_place, "preset '" + member.key + "' sets '" + value.key +
                                       "', which is not a parameter" +
                                       did_you_mean(value.key, manifest_.param_names()));
            continue;
        }
        const std::string label = "preset " + member.key + ", " + value.key;
        if (auto parsed = parse_param_value(*spec, value.value, label, diagnostics_))
            preset.values[value.key] = std::move(*parsed);
    }
    manifest_.presets.push_back(std::move(preset));
}

std::optional<EffectManifest> parse_manifest(const Node& written, const fs::path& folder,
                                             Diagnostics& diagnostics, const fs::path& glsl_folder,
                                             std::optional<ForeignEffect> foreign) {
    const int errors_before = diagnostics.error_count();
    const Node node = without_groups(written, diagnostics);
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    grammar::check(node, effect_block(), diagnostics);
    if (!node.is_object()) return std::nullopt;
    EffectManifest manifest;
    manifest.folder = folder;
    manifest.document = foreign ? std::move(foreign->document) : folder / "effect.json";
    if (foreign) manifest.generated = std::move(foreign->shaders);
    const grammar::Reader document(node, effect_block());
    ManifestParser parser(manifest, diagnostics);
    parser.identity(document);
    parser.modules(document, glsl_folder);
    parser.inputs(document);
    parser.outputs(document);
    parser.declarations(document, &ManifestParser::uses);
    parser.declarations(document, &ManifestParser::params);
    parser.reach(document);
    check_relation_declarations(manifest.params, diagnostics);
    parser.declarations(document, &ManifestParser::textures);
    parser.declarations(document, &ManifestParser::buffers);
    parser.declarations(document, &ManifestParser::tiles);
    parser.native(document);
    parser.declarations(document, &ManifestParser::passes);
    // Whatever uses what a module would declare, or a shader cannot say, would seem to be wrong.
    if (parser.has_all_modules()) {
        parser.telemetry(document);
        parser.presets(document);
        note_identities(manifest);
        if (write_out(manifest, glsl_folder, diagnostics)) check_manifest(manifest, diagnostics);
    }
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return manifest;
}

}  // namespace aftershade
