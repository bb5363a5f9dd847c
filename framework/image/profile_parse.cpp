#include <algorithm>
#include <utility>

#include "framework/core/param.h"
#include "framework/core/units.h"
#include "framework/image/camera.h"
#include "framework/image/color_space.h"
#include "framework/image/profile.h"
#include "framework/image/role.h"

namespace aftershade {

namespace fs = std::filesystem;
using Presence = ObjectReader::Presence;

namespace {

template <typename Value>
using Names = std::vector<std::pair<std::string, Value>>;

const Names<VelocityDelta> kDeltas = {{"cur-prev", VelocityDelta::cur_minus_prev},
                                      {"prev-cur", VelocityDelta::prev_minus_cur},
                                      {"next-cur", VelocityDelta::next_minus_cur},
                                      {"cur-next", VelocityDelta::cur_minus_next}};
const Names<VelocityUnit> kUnits = {
    {"px", VelocityUnit::px}, {"uv", VelocityUnit::uv}, {"ndc", VelocityUnit::ndc}};
const Names<DepthEncoding> kEncodings = {{"linear", DepthEncoding::linear},
                                         {"inverse", DepthEncoding::inverse},
                                         {"z_buffer", DepthEncoding::z_buffer},
                                         {"normalized", DepthEncoding::normalized}};

template <typename Value>
void read_choice(ObjectReader& reader, const std::string& key, const Names<Value>& names, Value& value) {
    std::vector<std::string> words;
    for (const auto& [word, meaning] : names) words.push_back(word);
    const auto chosen = reader.choice(key, words);
    for (const auto& [word, meaning] : names)
        if (chosen == word) value = meaning;
}

std::vector<std::string> read_names(const Node& list, Diagnostics& diagnostics) {
    std::vector<std::string> names;
    for (const Node& item : list.items) {
        if (item.is_string()) names.push_back(item.string);
        else diagnostics.error(item.place, "a channel name must be a string");
    }
    return names;
}

/// "channels": [...], "sum": [[...], [...]], or one key per component: "x": "forward.u", "y": "forward.v".
void read_layers(ObjectReader& reader, const ChannelRole& role, const Node& node, RoleDecoding& decoding,
                 Diagnostics& diagnostics) {
    const std::size_t components = std::size_t(role.channels);
    if (const Node* channels = reader.array("channels"))
        decoding.layers.push_back(read_names(*channels, diagnostics));
    if (const Node* sum = reader.array("sum"))
        for (const Node& layer : sum->items) decoding.layers.push_back(read_names(layer, diagnostics));
    std::vector<std::string> by_component;
    for (const std::string& native : role.native_channels) {
        // "velocity.X" -> "x", "Z" -> "z"
        std::string key(1, char(std::tolower(static_cast<unsigned char>(native.back()))));
        if (const auto name = reader.text(key)) by_component.push_back(*name);
    }
    if (role.has_optional_alpha() && by_component.size() + 1 == components) by_component.push_back("A?");
    if (!by_component.empty()) decoding.layers.push_back(by_component);
    for (const auto& layer : decoding.layers)
        if (layer.size() != components)
            diagnostics.error(node.place, "role '" + role.name + "' has " + std::to_string(components) +
                                              " channels, not " + std::to_string(layer.size()));
    if (decoding.layers.empty() && node.is_object())
        diagnostics.error(node.place,
                          "role '" + role.name + "' needs 'channels', or 'sum' with lists of channels");
}

std::optional<double> read_length_m(ObjectReader& reader, const std::string& key, Diagnostics& diagnostics) {
    const Node* value = reader.any(key);
    if (!value) return std::nullopt;
    ParamSpec spec;
    spec.unit = "m";
    spec.min = 0;
    const auto parsed = parse_param_value(spec, *value, key, diagnostics);
    return parsed ? std::optional(std::get<double>(*parsed)) : std::nullopt;
}

void read_depth(ObjectReader& reader, RoleDecoding& decoding, Diagnostics& diagnostics) {
    decoding.scale = float(reader.number("scale").value_or(1.0));
    if (const auto no_hit = reader.number("no_hit")) decoding.no_hit = float(*no_hit);
    if (const auto stored = reader.number("no_hit_stored")) decoding.no_hit_stored = float(*stored);
    decoding.zero_is_no_hit = reader.boolean("zero_is_no_hit").value_or(false);
    read_choice(reader, "encoding", kEncodings, decoding.encoding);
    decoding.reversed = reader.boolean("reversed").value_or(false);
    decoding.radial = reader.choice("kind", std::vector<std::string>{"planar", "radial"}) == "radial";
    decoding.near_m = read_length_m(reader, "near", diagnostics);
    decoding.far_m = read_length_m(reader, "far", diagnostics);
}

void read_velocity_scale(const Node& value, RoleDecoding& decoding, Diagnostics& diagnostics) {
    if (value.is_number()) {
        decoding.velocity_scale = {float(value.number), float(value.number)};
    } else if (value.is_array() && value.items.size() == 2 && value.items[0].is_number() &&
               value.items[1].is_number()) {
        decoding.velocity_scale = {float(value.items[0].number), float(value.items[1].number)};
    } else {
        diagnostics.error(value.place, "'scale' of a velocity is a number, or one for x and one for y");
    }
}

void read_velocity(ObjectReader& reader, const ChannelRole& role, const Node& node, RoleDecoding& decoding,
                   Diagnostics& diagnostics) {
    if (role.to_next) decoding.delta = VelocityDelta::next_minus_cur;
    read_choice(reader, "delta", kDeltas, decoding.delta);
    const bool is_next =
        decoding.delta == VelocityDelta::next_minus_cur || decoding.delta == VelocityDelta::cur_minus_next;
    if (is_next != role.to_next && node.find("delta"))
        diagnostics.error(node.find("delta")->place,
                          "role '" + role.name + "' cannot be decoded from '" + node.find("delta")->string +
                              "': 'next' vectors fill velocity_next and no other role");
    decoding.y_axis_up = reader.choice("y_axis", std::vector<std::string>{"up", "down"}) == "up";
    read_choice(reader, "unit", kUnits, decoding.unit);
    if (const Node* scale = reader.any("scale")) read_velocity_scale(*scale, decoding, diagnostics);
    decoding.bias = float(reader.number("bias").value_or(0.0));
    decoding.premultiplied = reader.boolean("premultiplied").value_or(false);
    if (const auto above = reader.number("no_motion_above")) decoding.no_motion_above = float(*above);
    decoding.shutter_frames = reader.number("shutter_frames").value_or(1.0);
    if (decoding.shutter_frames <= 0)
        diagnostics.error(node.find("shutter_frames")->place, "'shutter_frames' must be above 0");
}

void read_camera_sources(const Node& section, Profile& profile, Diagnostics& diagnostics) {
    for (const Member& member : section.members) {
        const CameraField* field = find_camera_field(member.key);
        if (!field) {
            std::vector<std::string> known;
            for (const CameraField& candidate : camera_fields()) known.push_back(candidate.name);
            diagnostics.error(member.key_place,
                              "'" + member.key + "' is not a camera value" + did_you_mean(member.key, known));
            continue;
        }
        ObjectReader reader(member.value, "camera." + member.key, diagnostics);
        CameraSource source;
        source.attributes = reader.texts("attributes");
        source.unit = reader.text("unit").value_or(field->unit);
        if (source.unit != field->unit && !convert_unit(1, source.unit, field->unit))
            diagnostics.error(member.value.place, "'" + source.unit + "' does not convert to " + field->unit);
        reader.finish();
        profile.camera[member.key] = std::move(source);
    }
}

void read_facts(const Node& list, Profile& profile, Diagnostics& diagnostics) {
    for (const Node& item : list.items) {
        ObjectReader reader(item, "the fact", diagnostics);
        ProfileFact fact;
        fact.fact = reader.text("fact", Presence::required).value_or("");
        fact.verified = reader.text("verified").value_or("");
        fact.source = reader.text("source", Presence::required).value_or("");
        reader.finish();
        profile.facts.push_back(std::move(fact));
    }
}

std::string read_color_space(ObjectReader& reader) {
    std::vector<std::string> names = color_space_names();
    names.insert(names.begin(), "auto");
    return reader.choice("color_space", names).value_or("auto");
}

}  // namespace

RoleDecoding parse_role_decoding(const std::string& role_name, const Node& node, Diagnostics& diagnostics) {
    const ChannelRole role = *find_role(role_name);
    RoleDecoding decoding;
    ObjectReader reader(node, "the decoding of '" + role_name + "'", diagnostics);
    read_layers(reader, role, node, decoding, diagnostics);
    if (role.has_optional_alpha()) decoding.luminance = reader.text("luminance").value_or("");
    if (role.kind == RoleKind::distance) read_depth(reader, decoding, diagnostics);
    if (role.kind == RoleKind::motion) read_velocity(reader, role, node, decoding, diagnostics);
    reader.finish();
    return decoding;
}

std::optional<Profile> parse_profile(const Node& node, Diagnostics& diagnostics) {
    ObjectReader reader(node, "the profile", diagnostics);
    if (!reader.is_object()) return std::nullopt;
    check_document_version(reader, node, diagnostics);
    Profile profile;
    profile.id = reader.text("id", Presence::required).value_or("");
    profile.summary = reader.text("summary", Presence::required).value_or("");
    if (const Node* detect = reader.object("detect", Presence::required)) {
        ObjectReader rule(*detect, "'detect'", diagnostics);
        profile.detect_attributes = rule.texts("attributes");
        profile.detect_channels = rule.texts("channels");
        rule.finish();
    }
    profile.color_space = read_color_space(reader);
    profile.lens_model =
        reader.choice("lens_model", std::vector<std::string>{"thin", "pinhole"}).value_or("");
    if (const Node* roles = reader.object("roles", Presence::required)) {
        for (const Member& member : roles->members) {
            if (find_role(member.key)) {
                profile.roles[member.key] = parse_role_decoding(member.key, member.value, diagnostics);
            } else {
                diagnostics.error(member.key_place, "'" + member.key + "' is not a role" +
                                                        did_you_mean(member.key, role_names()));
            }
        }
    }
    if (const Node* camera = reader.object("camera")) read_camera_sources(*camera, profile, diagnostics);
    if (const Node* facts = reader.array("facts")) read_facts(*facts, profile, diagnostics);
    reader.finish();
    return profile;
}

std::vector<Profile> read_profiles(const std::vector<fs::path>& folders, Diagnostics& diagnostics) {
    std::map<std::string, Profile> by_id;
    for (const fs::path& folder : folders) {
        std::vector<fs::path> files;
        std::error_code failure;
        for (const auto& entry : fs::directory_iterator(folder, failure))
            if (entry.path().extension() == ".json") files.push_back(entry.path());
        if (failure) diagnostics.error({folder.string()}, "cannot list the profiles: " + failure.message());
        std::sort(files.begin(), files.end());
        for (const fs::path& file : files)
            if (const auto node = read_document(file, diagnostics))
                if (auto profile = parse_profile(*node, diagnostics))
                    by_id.emplace(profile->id, std::move(*profile));
    }
    std::vector<Profile> profiles;
    for (auto& [id, profile] : by_id) profiles.push_back(std::move(profile));
    return profiles;
}

std::vector<Profile> read_profiles(const fs::path& folder, Diagnostics& diagnostics) {
    return read_profiles(std::vector<fs::path>{folder}, diagnostics);
}

}  // namespace aftershade
