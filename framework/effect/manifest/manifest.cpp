#include "framework/effect/manifest/manifest.h"

#include <algorithm>
#include <regex>
#include <set>
#include <utility>

#include "framework/core/text.h"
#include "framework/effect/manifest/manifest_check.h"
#include "framework/effect/manifest/manifest_expand.h"
#include "framework/effect/manifest/manifest_parser.h"
#include "framework/effect/param_types.h"
#include "framework/image/camera.h"

namespace aftershade {

namespace fs = std::filesystem;
using Presence = ObjectReader::Presence;

namespace {

template <typename T>
const T* find_named(const std::vector<T>& list, const std::string& name) {
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const T& item) { return item.name == name; });
    return found == list.end() ? nullptr : &*found;
}

}  // namespace

void ManifestParser::identifier(const std::string& name, const Place& place, const std::string& thing) {
    if (!is_snake_case(name)) fault(place, thing + " '" + name + "' " + kMustBeSnakeCase);
}

void ManifestParser::identity(ObjectReader& reader, const Node& node) {
    manifest_.id = reader.text("id", Presence::required).value_or("");
    const std::string folder = manifest_.folder.filename().string();
    if (const Node* id = node.find("id"); id && id->is_string()) {
        const Place& place = id->place;
        if (manifest_.id != folder)
            fault(place, "the id '" + manifest_.id + "' is not the name of its folder, '" + folder + "'");
        identifier(manifest_.id, place, "the id");
    }
    static const std::regex three_numbers(R"((0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*))");
    const auto version = reader.text("version", Presence::required);
    if (version && !std::regex_match(*version, three_numbers))
        fault(node.find("version")->place,
              "'version' is '" + *version + "' but must be MAJOR.MINOR.PATCH, such as 1.0.0");
    manifest_.version = version.value_or("");
    manifest_.summary = reader.text("summary", Presence::required).value_or("");
    manifest_.sources = reader.texts("sources");
    static const std::vector<std::string> accumulated{"subframes"};
    manifest_.accumulates_subframes = reader.choice("accumulates", accumulated).has_value();
}

void ManifestParser::uses(const Node& section) {
    static const std::vector<std::string> known{"lights"};
    std::set<std::string> named;
    for (const Node& item : section.items) {
        if (!item.is_string()) {
            fault(item.place, "'uses' holds names, not " + std::string(kind_name(item.kind)));
        } else if (item.string != known[0]) {
            fault(item.place, "'" + item.string + "' is nothing that shaders can use" +
                                  did_you_mean(item.string, known) +
                                  " (known: " + list_of_names(known, "and") + ")");
        } else {
            if (!named.insert(item.string).second) fault(item.place, "'" + item.string + "' is named twice");
            if (!manifest_.uses_lights) manifest_.uses_lights = item.place;
        }
    }
}

void ManifestParser::params(const Node& section) {
    for (const Member& member : section.members) {
        identifier(member.key, member.key_place, "parameter");
        if (!is_new("parameter", member)) continue;
        const auto spec = parse_param_spec(member.key, member.value, diagnostics_, param_types());
        if (!spec) {
            faulty_params_.insert(member.key);
            continue;
        }
        if (const Node* from = member.value.find("from")) check_from(*spec, from->place);
        manifest_.params.push_back(*spec);
    }
}

void ManifestParser::check_from(const ParamSpec& spec, const Place& place) {
    const std::vector<std::string> known = camera_sources(spec.type);
    if (std::find(known.begin(), known.end(), spec.from) == known.end())
        fault(place, unknown_source(spec.from, known));
}

void ManifestParser::presets(const Node& section) {
    for (const Member& member : section.members) preset(member);
}

void ManifestParser::preset(const Member& member) {
    PresetSpec preset;
    preset.name = member.key;
    if (!member.value.is_object())
        fault(member.value.place, "preset '" + member.key + "' must be an object, not " +
                                      std::string(kind_name(member.value.kind)));
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

const InputSpec* EffectManifest::find_input(const std::string& name) const {
    return find_named(inputs, name);
}
const OutputSpec* EffectManifest::find_output(const std::string& name) const {
    return find_named(outputs, name);
}
const ParamSpec* EffectManifest::find_param(const std::string& name) const {
    return find_named(params, name);
}
const TextureSpec* EffectManifest::find_texture(const std::string& name) const {
    return find_named(textures, name);
}
const BufferSpec* EffectManifest::find_buffer(const std::string& name) const {
    return find_named(buffers, name);
}
const TileListSpec* EffectManifest::find_tile_list(const std::string& name) const {
    return find_named(tiles, name);
}
const PresetSpec* EffectManifest::find_preset(const std::string& name) const {
    return find_named(presets, name);
}

bool EffectManifest::has_history() const {
    const auto any = [](const auto& list) {
        return std::any_of(list.begin(), list.end(), [](const auto& item) { return item.history; });
    };
    return any(inputs) || any(textures) || any(buffers);
}

std::vector<std::string> EffectManifest::param_names() const {
    std::vector<std::string> names;
    for (const ParamSpec& spec : params) names.push_back(spec.name);
    return names;
}

int EffectManifest::most_of(const CountSpec& count) const {
    const ParamSpec* spec = find_param(count.param);
    return spec && spec->max ? int(*spec->max) : count.number;
}

std::optional<EffectManifest> parse_manifest(const Node& node, const fs::path& folder,
                                             Diagnostics& diagnostics, const fs::path& glsl_folder) {
    ObjectReader reader(node, "the manifest", diagnostics);
    if (!reader.is_object()) return std::nullopt;
    const int errors_before = diagnostics.error_count();
    EffectManifest manifest;
    manifest.folder = folder;
    check_document_version(reader, node, diagnostics);
    reader.text("$schema");
    ManifestParser parser(manifest, diagnostics);
    parser.identity(reader, node);
    if (const Node* section = reader.array("modules")) parser.modules(*section, glsl_folder);
    if (const Node* section = reader.object("inputs", Presence::required)) parser.inputs(*section);
    if (const Node* section = reader.object("outputs", Presence::required)) parser.outputs(*section);
    parser.declarations("uses", reader.array("uses"), &ManifestParser::uses);
    parser.declarations("params", reader.object("params"), &ManifestParser::params);
    check_relation_declarations(manifest.params, diagnostics);
    parser.declarations("textures", reader.object("textures"), &ManifestParser::textures);
    parser.declarations("buffers", reader.object("buffers"), &ManifestParser::buffers);
    parser.declarations("tiles", reader.object("tiles"), &ManifestParser::tiles);
    if (const Node* section = reader.object("native")) parser.native(*section);
    parser.declarations("passes", reader.array("passes", Presence::required), &ManifestParser::passes);
    const Node* telemetry = reader.object("telemetry");
    if (telemetry && parser.has_all_modules()) parser.telemetry(*telemetry);
    const Node* presets = reader.object("presets");
    if (presets && parser.has_all_modules()) parser.presets(*presets);
    reader.finish();
    // Whatever uses what a module would declare, or a shader cannot say, would seem to be wrong.
    if (parser.has_all_modules() && write_out(manifest, glsl_folder, diagnostics))
        check_manifest(manifest, node, diagnostics);
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return manifest;
}

}  // namespace aftershade
