#include <algorithm>
#include <utility>

#include "framework/capture/capture_grammar.h"
#include "framework/capture/profile.h"
#include "framework/capture/profile_grammar.h"
#include "framework/document/grammar_reader.h"
#include "framework/image/camera.h"
#include "framework/image/role.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// "channels": [...], "sum": [[...], [...]], or one key per component: "x": "forward.u", "y": "forward.v".
void read_layers(const grammar::Reader& reader, const ChannelRole& role, RoleDecoding& decoding) {
    if (reader.has("channels")) decoding.layers.push_back(reader.texts("channels"));
    if (const Node* sum = reader.find("sum"))
        for (const Node& layer : sum->items) {
            decoding.layers.emplace_back();
            for (const Node& name : layer.items) decoding.layers.back().push_back(name.string);
        }
    std::vector<std::string> by_component;
    for (const std::string& native : role.native_channels)
        if (const std::string key = component_key(native); reader.has(key))
            by_component.push_back(reader.text(key));
    if (role.has_optional_alpha() && by_component.size() + 1 == std::size_t(role.channels))
        by_component.push_back("A?");
    if (!by_component.empty()) decoding.layers.push_back(by_component);
    // A name that stands for no channel and may be absent.
    for (auto& names : decoding.layers)
        if (role.has_optional_alpha() && names.size() + 1 == std::size_t(role.channels)) names.push_back("?");
}

std::optional<float> number_if(const grammar::Reader& reader, std::string_view key) {
    return reader.has(key) ? std::optional(float(reader.number(key))) : std::nullopt;
}

std::optional<double> length_m(const grammar::Reader& reader, std::string_view key) {
    return reader.has(key) ? std::optional(reader.components(key)[0]) : std::nullopt;
}

void read_depth(const grammar::Reader& reader, RoleDecoding& decoding) {
    decoding.scale = float(reader.number("scale"));
    decoding.no_hit = number_if(reader, "no_hit").value_or(decoding.no_hit);
    decoding.no_hit_stored = number_if(reader, "no_hit_stored");
    decoding.zero_is_no_hit = reader.boolean("zero_is_no_hit");
    decoding.encoding = reader.choice<DepthEncoding>("encoding");
    decoding.reversed = reader.boolean("reversed");
    decoding.radial = reader.text("kind") == "radial";
    decoding.near_m = length_m(reader, "near");
    decoding.far_m = length_m(reader, "far");
    decoding.offset_m = length_m(reader, "offset").value_or(0);
}

void read_velocity(const grammar::Reader& reader, RoleDecoding& decoding) {
    const auto& deltas = velocity_delta_names();
    decoding.delta =
        VelocityDelta(std::find(deltas.begin(), deltas.end(), reader.text("delta")) - deltas.begin());
    decoding.y_axis_up = reader.text("y_axis") == "up";
    decoding.unit = reader.choice<VelocityUnit>("unit");
    const std::vector<double> scale = reader.numbers("scale");
    decoding.velocity_scale = {float(scale.front()), float(scale.back())};
    decoding.bias = float(reader.number("bias"));
    decoding.premultiplied = reader.boolean("premultiplied");
    decoding.no_motion_above = number_if(reader, "no_motion_above");
    decoding.no_motion_below = number_if(reader, "no_motion_below");
    decoding.shutter_frames = reader.number("shutter_frames");
}

void read_irradiance(const grammar::Reader& reader, RoleDecoding& decoding) {
    decoding.plus = reader.texts("plus");
    decoding.times_albedo = reader.boolean("times_albedo");
    decoding.scale = float(reader.number("scale"));
    decoding.albedo_floor = reader.number("albedo_floor");
}

RoleDecoding read_decoding(const ChannelRole& role, const grammar::Reader& reader) {
    RoleDecoding decoding;
    read_layers(reader, role, decoding);
    if (role.has_optional_alpha()) decoding.luminance = reader.text("luminance");
    if (can_be_mean(role)) decoding.is_mean = reader.text("sampling") == "mean";
    if (role.kind == RoleKind::distance) read_depth(reader, decoding);
    if (role.kind == RoleKind::motion) read_velocity(reader, decoding);
    if (role.name == kIrradianceRole) read_irradiance(reader, decoding);
    return decoding;
}

RoleDecoding read_decoding(const std::string& role_name, const Node& node) {
    const grammar::Reader reader(node, decoding_block(role_name));
    const ChannelRole role = *find_role(role_name);
    RoleDecoding decoding = read_decoding(role, reader);
    if (role.name == kIrradianceRole)
        for (const grammar::Reader& other : reader.objects("else"))
            decoding.otherwise.push_back(read_decoding(role, other));
    return decoding;
}

void read_camera_sources(const grammar::Reader& camera, Profile& profile) {
    for (const CameraField& field : camera_fields())
        if (const auto source = camera.object(field.name)) {
            const bool has_unit = !field.unit.empty() && source->has("unit");
            profile.camera[field.name] = {
                source->texts("attributes"), has_unit ? source->text("unit") : field.unit,
                counts_in_sensor_widths(field) && source->boolean("times_sensor_width")};
        }
    if (const auto source = camera.object(kFieldOfView))
        profile.field_of_view = {source->texts("attributes"),
                                 source->has("unit") ? source->text("unit") : "deg"};
}

/// profile.schema.json is none.
bool is_profile(const fs::path& path) {
    return path.extension() == ".json" && path.stem().extension() != ".schema";
}

}  // namespace

std::map<std::string, RoleDecoding> read_decodings(const Node& node) {
    std::map<std::string, RoleDecoding> decodings;
    for (const Member& member : node.members)
        if (find_role(member.key)) decodings[member.key] = read_decoding(member.key, member.value);
    return decodings;
}

std::optional<Profile> parse_profile(const Node& node, Diagnostics& diagnostics) {
    grammar::check(node, profile_block(), diagnostics);
    if (!node.is_object()) return std::nullopt;
    const grammar::Reader reader(node, profile_block());
    Profile profile;
    profile.id = reader.text("id");
    profile.summary = reader.text("summary");
    if (const auto detect = reader.object("detect")) {
        profile.detect_attributes = detect->texts("attributes");
        profile.detect_channels = detect->texts("channels");
        profile.rewrites = detect->boolean("rewrites");
    }
    profile.color_space = reader.text("color_space");
    profile.lens_model = reader.text("lens_model");
    if (const Node* roles = reader.find("roles")) profile.roles = read_decodings(*roles);
    if (const Node* remedies = reader.find("remedies"))
        for (const Member& member : remedies->members) profile.remedies[member.key] = member.value.string;
    if (const auto camera = reader.object("camera")) read_camera_sources(*camera, profile);
    profile.seen_on = reader.texts("seen_on");
    for (const grammar::Reader& fact : reader.objects("facts"))
        profile.facts.push_back({fact.text("fact"), fact.text("verified"), fact.text("source")});
    return profile;
}

std::vector<Profile> read_profiles(const std::vector<fs::path>& folders, Diagnostics& diagnostics) {
    std::map<std::string, Profile> by_id;
    for (const fs::path& folder : folders) {
        std::vector<fs::path> files;
        std::error_code failure;
        for (const auto& entry : fs::directory_iterator(folder, failure))
            if (is_profile(entry.path())) files.push_back(entry.path());
        if (failure) diagnostics.error({folder.string()}, "cannot list the profiles: " + failure.message());
        std::sort(files.begin(), files.end());
        for (const fs::path& file : files)
            if (const auto node = read_document(file, diagnostics))
                if (auto profile = parse_profile(*node, diagnostics)) {
                    profile->file = file;
                    by_id.emplace(profile->id, std::move(*profile));
                }
    }
    std::vector<Profile> profiles;
    for (auto& [id, profile] : by_id) profiles.push_back(std::move(profile));
    return profiles;
}

std::vector<Profile> read_profiles(const fs::path& folder, Diagnostics& diagnostics) {
    return read_profiles(std::vector<fs::path>{folder}, diagnostics);
}

}  // namespace aftershade
