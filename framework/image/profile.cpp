#include "framework/image/profile.h"

#include <algorithm>
#include <array>

#include "framework/core/error.h"
#include "framework/image/role.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kLayer = "{layer}";

constexpr std::array<std::pair<std::string_view, VelocityDelta>, 4> kDeltas = {{
    {"cur-prev", VelocityDelta::cur_minus_prev},
    {"prev-cur", VelocityDelta::prev_minus_cur},
    {"next-cur", VelocityDelta::next_minus_cur},
    {"cur-next", VelocityDelta::cur_minus_next},
}};

std::vector<std::string> split_alternatives(const std::string& text) {
    std::vector<std::string> parts;
    std::size_t start = 0;
    for (std::size_t bar; (bar = text.find('|', start)) != std::string::npos; start = bar + 1)
        parts.push_back(text.substr(start, bar - start));
    parts.push_back(text.substr(start));
    return parts;
}

bool has_channel(const ExrPart& part, const std::string& name) {
    return std::any_of(part.channels.begin(), part.channels.end(), [&](const auto& c) { return c.name == name; });
}

std::string with_layer(const std::string& pattern, const std::string& layer) {
    if (!pattern.starts_with(kLayer)) return pattern;
    return layer + pattern.substr(kLayer.size());
}

/// The first of "a|b|c" that the part has; "" where it has none.
std::string first_present(const std::string& alternatives, const std::string& layer, const ExrPart& part) {
    for (const std::string& pattern : split_alternatives(alternatives))
        if (const std::string name = with_layer(pattern, layer); has_channel(part, name)) return name;
    return "";
}

std::vector<std::string> read_names(const Node& list, Diagnostics& diagnostics) {
    std::vector<std::string> names;
    for (const Node& item : list.items) {
        if (item.is_string()) names.push_back(item.string);
        else diagnostics.error(item.place, "a channel name must be a string");
    }
    return names;
}

void read_delta(ObjectReader& reader, const std::string& role, const Node& node, RoleDecoding& decoding,
                Diagnostics& diagnostics) {
    std::vector<std::string> names;
    for (const auto& [name, delta] : kDeltas) names.emplace_back(name);
    const auto chosen = reader.choice("delta", names);
    if (!chosen) return;
    for (const auto& [name, delta] : kDeltas)
        if (name == *chosen) decoding.delta = delta;
    const bool is_next = chosen->find("next") != std::string::npos;
    if (is_next != (role == "velocity_next"))
        diagnostics.error(node.find("delta")->place, "role '" + role + "' cannot be decoded from '" + *chosen +
                                                         "': 'next' vectors fill velocity_next and no other role");
}

RoleDecoding parse_decoding(const std::string& role, const Node& node, Diagnostics& diagnostics) {
    RoleDecoding decoding;
    ObjectReader reader(node, "the decoding of '" + role + "'", diagnostics);
    const std::size_t components = std::size_t(find_role(role)->channels);
    if (const Node* channels = reader.array("channels")) decoding.layers.push_back(read_names(*channels, diagnostics));
    if (const Node* sum = reader.array("sum"))
        for (const Node& layer : sum->items) decoding.layers.push_back(read_names(layer, diagnostics));
    for (const auto& layer : decoding.layers)
        if (layer.size() != components)
            diagnostics.error(node.place, "role '" + role + "' has " + std::to_string(components) + " channels, not " +
                                              std::to_string(layer.size()));
    if (decoding.layers.empty() && node.is_object())
        diagnostics.error(node.place, "role '" + role + "' needs 'channels', or 'sum' with lists of channels");
    decoding.scale = float(reader.number("scale").value_or(1.0));
    if (const auto no_hit = reader.number("no_hit")) decoding.no_hit = float(*no_hit);
    if (role == "velocity_next") decoding.delta = VelocityDelta::next_minus_cur;
    read_delta(reader, role, node, decoding, diagnostics);
    decoding.y_axis_up = reader.choice("y_axis", std::vector<std::string>{"up", "down"}) == "up";
    reader.finish();
    return decoding;
}

}  // namespace

std::optional<Profile> parse_profile(const Node& node, Diagnostics& diagnostics) {
    using Presence = ObjectReader::Presence;
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
    if (const Node* roles = reader.object("roles", Presence::required)) {
        for (const Member& member : roles->members) {
            if (find_role(member.key)) {
                profile.roles[member.key] = parse_decoding(member.key, member.value, diagnostics);
            } else {
                diagnostics.error(member.key_place,
                                  "'" + member.key + "' is not a role" + did_you_mean(member.key, role_names()));
            }
        }
    }
    reader.finish();
    return profile;
}

std::vector<Profile> read_profiles(const fs::path& folder, Diagnostics& diagnostics) {
    std::vector<fs::path> files;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    if (failure) diagnostics.error({folder.string()}, "cannot list the profiles: " + failure.message());
    std::sort(files.begin(), files.end());
    std::vector<Profile> profiles;
    for (const fs::path& file : files)
        if (const auto node = read_document(file, diagnostics))
            if (auto profile = parse_profile(*node, diagnostics)) profiles.push_back(std::move(*profile));
    return profiles;
}

std::optional<FoundChannels> find_channels(const RoleDecoding& decoding, const std::string& layer,
                                           const ExrPart& part) {
    FoundChannels found;
    for (const auto& names : decoding.layers) {
        auto& components = found.emplace_back();
        for (std::string pattern : names) {
            const bool optional = pattern.ends_with('?');
            if (optional) pattern.pop_back();
            components.push_back(first_present(pattern, layer, part));
            if (components.back().empty() && !optional) return std::nullopt;
        }
    }
    return found;
}

std::string find_layer(const Profile& profile, const ExrPart& part) {
    const auto color = profile.roles.find("color");
    if (color == profile.roles.end() || color->second.layers.empty()) return "";
    for (const std::string& pattern : split_alternatives(color->second.layers[0][0])) {
        if (!pattern.starts_with(kLayer)) continue;
        const std::string ending = pattern.substr(kLayer.size());
        for (const ExrChannel& channel : part.channels)
            if (channel.name.size() > ending.size() && channel.name.ends_with(ending))
                return channel.name.substr(0, channel.name.size() - ending.size());
    }
    return "";
}

ProfileChoice detect_profile(const std::vector<Profile>& profiles, const ExrPart& part, const std::string& path) {
    const std::vector<std::string> attributes = part.metadata.names();
    std::vector<ProfileChoice> by_attribute, by_channels;
    for (const Profile& profile : profiles) {
        for (const std::string& name : profile.detect_attributes)
            if (std::find(attributes.begin(), attributes.end(), name) != attributes.end()) {
                by_attribute.push_back({&profile, "attribute " + name});
                break;
            }
        RoleDecoding wanted;
        wanted.layers = {profile.detect_channels};
        const std::string layer = find_layer(profile, part);
        const auto found = find_channels(wanted, layer, part);
        if (found && !profile.detect_channels.empty())
            by_channels.push_back({&profile, "channel " + found->front().front()});
    }
    // An attribute is one producer's own mark; channel names are shared by several.
    const auto& fitting = by_attribute.empty() ? by_channels : by_attribute;
    if (fitting.size() == 1) return fitting.front();
    std::vector<std::string> ids;
    for (const ProfileChoice& choice : fitting) ids.push_back(choice.profile->id);
    if (fitting.empty())
        throw Error(ExitCode::capture, path + ": no profile fits its channels (name one with --profile)");
    throw Error(ExitCode::usage, path + ": the profiles " + list_of_names(ids, "and") +
                                     " fit alike (name one with --profile, or as 'profile' in capture.json)");
}

}  // namespace aftershade
