#include "framework/effect/manifest.h"

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

#include "framework/effect/manifest_check.h"
#include "framework/image/camera.h"
#include "framework/image/role.h"

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

/// Reads the sections of one manifest into it.
struct ManifestParser {
    EffectManifest& manifest;
    Diagnostics& diagnostics;

    void identifier(const std::string& name, const Place& place, const std::string& thing) {
        static const std::regex rule("[a-z][a-z0-9_]*");
        if (!std::regex_match(name, rule))
            diagnostics.error(
                place, thing + " '" + name + "' must be snake_case: a-z, 0-9 and _, beginning with a letter");
    }

    std::string role(ObjectReader& reader, const Node& node) {
        const auto name = reader.text("role", Presence::required);
        if (name && !find_role(*name))
            diagnostics.error(node.find("role")->place,
                              "'" + *name + "' is not a role" + did_you_mean(*name, role_names()));
        return name.value_or("");
    }

    void inputs(const Node& section) {
        for (const Member& member : section.members) {
            identifier(member.key, member.key_place, "input");
            ObjectReader reader(member.value, "input '" + member.key + "'", diagnostics);
            InputSpec input;
            input.name = member.key;
            input.place = member.key_place;
            input.role = role(reader, member.value);
            input.optional = reader.boolean("optional").value_or(false);
            input.doc = reader.text("doc").value_or("");
            reader.finish();
            manifest.inputs.push_back(std::move(input));
        }
    }

    void outputs(const Node& section) {
        for (const Member& member : section.members) {
            identifier(member.key, member.key_place, "output");
            ObjectReader reader(member.value, "output '" + member.key + "'", diagnostics);
            OutputSpec output;
            output.name = member.key;
            output.place = member.key_place;
            output.role = role(reader, member.value);
            output.doc = reader.text("doc").value_or("");
            reader.finish();
            manifest.outputs.push_back(std::move(output));
        }
    }

    void params(const Node& section) {
        for (const Member& member : section.members) {
            identifier(member.key, member.key_place, "parameter");
            const auto spec = parse_param_spec(member.key, member.value, diagnostics);
            if (!spec) continue;
            if (!spec->from.empty()) check_from(*spec, member.value.find("from")->place);
            manifest.params.push_back(*spec);
        }
    }

    void check_from(const ParamSpec& spec, const Place& place) {
        constexpr std::string_view kCamera = "camera.";
        std::vector<std::string> known;
        if (spec.type == ParamType::enum_) known.push_back(std::string(kCamera) + "lens_model");
        else
            for (const CameraField& field : camera_fields())
                known.push_back(std::string(kCamera) + field.name);
        if (std::find(known.begin(), known.end(), spec.from) == known.end())
            diagnostics.error(place, "'" + spec.from + "' is not a value of the capture" +
                                         did_you_mean(spec.from, known) +
                                         " (known: " + list_of_names(known, "and") + ")");
    }

    void textures(const Node& section) {
        for (const Member& member : section.members) {
            identifier(member.key, member.key_place, "texture");
            ObjectReader reader(member.value, "texture '" + member.key + "'", diagnostics);
            TextureSpec texture;
            texture.name = member.key;
            texture.place = member.key_place;
            texture.doc = reader.text("doc", Presence::required).value_or("");
            std::vector<std::string> formats;
            for (const auto name : gpu::texture_format_names()) formats.emplace_back(name);
            if (const auto format = reader.choice("format", formats, Presence::required))
                texture.format = *gpu::parse_texture_format(*format);
            texture.scale = reader.number("scale").value_or(1.0);
            if (texture.scale <= 0 || texture.scale > 4)
                diagnostics.error(member.value.find("scale")->place, "'scale' must be above 0 and at most 4");
            if (const auto tile = reader.integer("tile")) {
                texture.tile = int(*tile);
                if (*tile < 2 || *tile > 4096)
                    diagnostics.error(member.value.find("tile")->place, "'tile' must be from 2 to 4096 px");
                if (member.value.find("scale"))
                    diagnostics.error(member.value.place, "a texture has 'scale' or 'tile', not both");
            }
            reader.finish();
            manifest.textures.push_back(std::move(texture));
        }
    }

    ReadSpec read(const Node& node) {
        ReadSpec read;
        read.place = node.place;
        if (node.is_string()) {
            read.name = node.string;
            return read;
        }
        if (!node.is_object() || node.members.size() != 1) {
            diagnostics.error(
                node.place,
                "a read is a name, or an object of one name with its filter: {\"color\": \"linear\"}");
            return read;
        }
        const Member& member = node.members[0];
        read.name = member.key;
        if (member.value.is_object()) {
            ObjectReader reader(member.value, "the read of '" + member.key + "'", diagnostics);
            if (reader.choice("filter", kFilters) == "linear") read.filter = gpu::Filter::linear;
            if (reader.choice("outside", kOutside) == "zero") read.wrap = gpu::Wrap::zero;
            reader.finish();
        } else if (member.value.is_string() &&
                   (member.value.string == "linear" || member.value.string == "nearest")) {
            if (member.value.string == "linear") read.filter = gpu::Filter::linear;
        } else {
            diagnostics.error(member.value.place, "the filter of a read is 'nearest' or 'linear'");
        }
        return read;
    }

    WhenSpec when(const Member& member) {
        WhenSpec condition;
        condition.subject = member.key;
        condition.place = member.key_place;
        const auto add = [&](const Node& value) {
            if (value.kind == Node::Kind::boolean) condition.values.emplace_back(value.boolean);
            else if (value.kind == Node::Kind::integer) condition.values.emplace_back(value.integer);
            else if (value.is_string()) condition.values.emplace_back(value.string);
            else
                diagnostics.error(value.place, "a condition compares with true, false, an integer or a name");
        };
        if (member.value.is_array())
            for (const Node& item : member.value.items) add(item);
        else add(member.value);
        if (member.value.is_array() && member.value.items.empty())
            diagnostics.error(member.value.place,
                              "the condition '" + member.key + "' has no value, so it never holds");
        return condition;
    }

    void passes(const Node& section) {
        for (const Node& node : section.items) {
            ObjectReader reader(node, "the pass", diagnostics);
            if (!reader.is_object()) continue;
            PassSpec pass;
            pass.place = node.place;
            pass.name = reader.text("name", Presence::required).value_or("");
            if (node.find("name")) identifier(pass.name, node.find("name")->place, "pass");
            pass.shader = reader.text("shader", Presence::required).value_or("");
            if (const Node* reads = reader.array("reads"))
                for (const Node& item : reads->items) pass.reads.push_back(read(item));
            pass.writes = reader.texts("writes");
            if (const Node* defines = reader.object("defines"))
                for (const Member& member : defines->members) define(pass, member);
            if (const Node* conditions = reader.object("when"))
                for (const Member& member : conditions->members) pass.when.push_back(when(member));
            reader.finish();
            manifest.passes.push_back(std::move(pass));
        }
    }

    void define(PassSpec& pass, const Member& member) {
        static const std::regex rule("[A-Za-z_][A-Za-z0-9_]*");
        if (!std::regex_match(member.key, rule))
            diagnostics.error(member.key_place,
                              "'" + member.key + "' cannot name a define: letters, 0-9 and _ only");
        if (member.value.is_string()) pass.defines[member.key] = member.value.string;
        else if (member.value.kind == Node::Kind::integer)
            pass.defines[member.key] = std::to_string(member.value.integer);
        else diagnostics.error(member.value.place, "a define is a string or an integer");
    }

    void presets(const Node& section) {
        for (const Member& member : section.members) {
            PresetSpec preset;
            preset.name = member.key;
            if (!member.value.is_object())
                diagnostics.error(member.value.place, "preset '" + member.key + "' must be an object, not " +
                                                          std::string(kind_name(member.value.kind)));
            for (const Member& value : member.value.members) {
                const ParamSpec* spec = manifest.find_param(value.key);
                if (!spec) {
                    diagnostics.error(value.key_place, "preset '" + member.key + "' sets '" + value.key +
                                                           "', which is not a parameter" +
                                                           did_you_mean(value.key, manifest.param_names()));
                    continue;
                }
                const std::string label = "preset " + member.key + ", " + value.key;
                if (auto parsed = parse_param_value(*spec, value.value, label, diagnostics))
                    preset.values[value.key] = std::move(*parsed);
            }
            manifest.presets.push_back(std::move(preset));
        }
    }

    const std::vector<std::string> kFilters{"nearest", "linear"};
    const std::vector<std::string> kOutside{"clamp", "zero"};
};

}  // namespace

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
const PresetSpec* EffectManifest::find_preset(const std::string& name) const {
    return find_named(presets, name);
}

std::vector<std::string> EffectManifest::param_names() const {
    std::vector<std::string> names;
    for (const ParamSpec& spec : params) names.push_back(spec.name);
    return names;
}

std::optional<EffectManifest> parse_manifest(const Node& node, const fs::path& folder,
                                             Diagnostics& diagnostics) {
    ObjectReader reader(node, "the manifest", diagnostics);
    if (!reader.is_object()) return std::nullopt;
    const int errors_before = diagnostics.error_count();
    EffectManifest manifest;
    manifest.folder = folder;
    check_document_version(reader, node, diagnostics);
    reader.text("$schema");
    manifest.id = reader.text("id", Presence::required).value_or("");
    if (!manifest.id.empty() && manifest.id != folder.filename().string())
        diagnostics.error(node.find("id")->place, "the id '" + manifest.id +
                                                      "' is not the name of its folder, '" +
                                                      folder.filename().string() + "'");
    ManifestParser parser{manifest, diagnostics};
    if (!manifest.id.empty()) parser.identifier(manifest.id, node.find("id")->place, "the id");
    manifest.version = reader.text("version", Presence::required).value_or("");
    manifest.summary = reader.text("summary", Presence::required).value_or("");
    manifest.sources = reader.texts("sources");

    if (const Node* section = reader.object("inputs", Presence::required)) parser.inputs(*section);
    if (const Node* section = reader.object("outputs", Presence::required)) parser.outputs(*section);
    if (const Node* section = reader.object("params")) parser.params(*section);
    if (const Node* section = reader.object("textures")) parser.textures(*section);
    if (const Node* section = reader.array("passes", Presence::required)) parser.passes(*section);
    if (const Node* section = reader.object("presets")) parser.presets(*section);
    reader.finish();
    check_manifest(manifest, node, diagnostics);
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return manifest;
}

}  // namespace aftershade
