#include "framework/capture/profile.h"

#include <algorithm>

#include "framework/capture/common_names.h"
#include "framework/core/error.h"
#include "framework/core/text.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

constexpr std::string_view kLayer = "{layer}";

std::vector<std::string> split_alternatives(const std::string& text) {
    std::vector<std::string> parts;
    std::size_t start = 0;
    for (std::size_t bar; (bar = text.find('|', start)) != std::string::npos; start = bar + 1)
        parts.push_back(text.substr(start, bar - start));
    parts.push_back(text.substr(start));
    return parts;
}

/// The channel that goes by the name; "" where none does.
std::string channel_called(const ExrPart& part, const std::string& name, bool in_any_case) {
    const auto is_it = [&](const std::string& one) {
        return in_any_case ? lower_case(one) == lower_case(name) : one == name || matches_pattern(one, name);
    };
    for (const ExrChannel& channel : part.channels)
        if (is_it(channel.name)) return channel.name;
    for (const auto& [other, channel] : part.other_names)
        if (is_it(other)) return channel;
    return "";
}

/// In a file without layers nothing stands before the rest of the name.
std::string with_layer(const std::string& pattern, const std::string& layer) {
    if (!pattern.starts_with(kLayer)) return pattern;
    return layer.empty() ? pattern.substr(kLayer.size() + 1) : layer + pattern.substr(kLayer.size());
}

/// The first of "a|b|c" that the part has; "" where it has none.
std::string first_present(const std::string& alternatives, const std::string& layer, const ExrPart& part,
                          bool in_any_case) {
    for (const std::string& pattern : split_alternatives(alternatives))
        if (const std::string name = channel_called(part, with_layer(pattern, layer), in_any_case);
            !name.empty())
            return name;
    return "";
}

std::optional<FoundChannels> find_in(const RoleDecoding& decoding, const std::string& layer,
                                     const ExrPart& part, bool in_any_case) {
    FoundChannels found;
    for (const auto& names : decoding.layers) {
        auto& components = found.emplace_back();
        for (std::string pattern : names) {
            const bool optional = pattern.ends_with('?');
            if (optional) pattern.pop_back();
            components.push_back(first_present(pattern, layer, part, in_any_case));
            if (components.back().empty() && !optional) return std::nullopt;
        }
    }
    return found;
}

/// What we wrote without the producer's own channels.
bool has_native_names(const ExrPart& part) {
    return part.metadata.text("aftershade/channels") == "native";
}

const Profile* profile_called(const std::vector<Profile>& profiles, const std::string& id) {
    const auto found =
        std::find_if(profiles.begin(), profiles.end(), [&](const Profile& one) { return one.id == id; });
    return found == profiles.end() ? nullptr : &*found;
}

/// Of several, those that write nothing but their own files.
void leave_out_rewriters(std::vector<ProfileChoice>& choices) {
    const auto rewrites = [](const ProfileChoice& choice) { return choice.profile->rewrites; };
    if (!std::all_of(choices.begin(), choices.end(), rewrites)) std::erase_if(choices, rewrites);
}

}  // namespace

std::optional<FoundChannels> find_channels(const RoleDecoding& decoding, const std::string& layer,
                                           const ExrPart& part) {
    const auto found = find_in(decoding, layer, part, false);
    return found ? found : find_in(decoding, layer, part, true);
}

std::vector<std::string> find_layers(const Profile& profile, const ExrPart& part) {
    std::vector<std::string> layers;
    const auto color = profile.roles.find(kColorRole);
    if (color == profile.roles.end() || color->second.layers.empty()) return layers;
    for (const std::string& pattern : split_alternatives(color->second.layers[0][0])) {
        if (!pattern.starts_with(kLayer)) continue;
        const std::string ending = pattern.substr(kLayer.size());
        for (const ExrChannel& channel : part.channels) {
            if (channel.name.size() <= ending.size() || !channel.name.ends_with(ending)) continue;
            const std::string layer = channel.name.substr(0, channel.name.size() - ending.size());
            if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
        }
    }
    return layers;
}

std::string find_layer(const Profile& profile, const ExrPart& part) {
    const std::vector<std::string> layers = find_layers(profile, part);
    return layers.empty() ? "" : layers.front();
}

bool matches_pattern(const std::string& name, const std::string& pattern) {
    const std::size_t star = pattern.find('*');
    if (star == std::string::npos) return name == pattern;
    if (name.substr(0, star) != pattern.substr(0, star)) return false;
    const std::string rest = pattern.substr(star + 1);
    for (std::size_t at = star; at <= name.size(); ++at)
        if (matches_pattern(name.substr(at), rest)) return true;
    return false;
}

namespace {

/// The attribute that "name" or "name=text" fits; "" where none does.
std::string attribute_called(const ExrMetadata& metadata, const std::string& pattern) {
    const std::size_t equals = pattern.find('=');
    const std::string name_pattern = pattern.substr(0, equals);
    for (const std::string& name : metadata.names()) {
        if (!matches_pattern(name, name_pattern)) continue;
        if (equals == std::string::npos) return name;
        const auto text = metadata.text(name);
        if (text && matches_pattern(*text, pattern.substr(equals + 1))) return name;
    }
    return "";
}

}  // namespace

ProfileChoice detect_profile(const std::vector<Profile>& profiles, const ExrPart& part,
                             const std::string& path) {
    const Profile* const native = profile_called(profiles, "native");
    if (native && has_native_names(part)) return {native, "attribute aftershade/channels"};
    std::vector<ProfileChoice> by_attribute, by_channels;
    std::size_t most_channels = 1;
    for (const Profile& profile : profiles) {
        for (const std::string& pattern : profile.detect_attributes) {
            const std::string name = attribute_called(part.metadata, pattern);
            if (name.empty()) continue;
            by_attribute.push_back({&profile, "attribute " + name});
            break;
        }
        RoleDecoding wanted;
        wanted.layers = {profile.detect_channels};
        const auto found = find_in(wanted, find_layer(profile, part), part, false);
        if (!found || profile.detect_channels.size() < most_channels) continue;
        // A profile that asks for more of what is there says more of where the file comes from.
        if (profile.detect_channels.size() > most_channels) by_channels.clear();
        most_channels = profile.detect_channels.size();
        by_channels.push_back({&profile, "channel " + found->front().back()});
    }
    leave_out_rewriters(by_attribute);
    // An attribute is one producer's own mark; channel names are shared by several.
    const auto& fitting = by_attribute.empty() ? by_channels : by_attribute;
    if (fitting.size() == 1) return fitting.front();
    std::vector<std::string> ids;
    for (const ProfileChoice& choice : fitting) ids.push_back(choice.profile->id);
    if (fitting.empty() && native && find_common_color(part, ""))
        return {native, "no producer's mark, but a plain colour"};
    if (fitting.empty())
        throw Error(ExitCode::capture, path + ": no profile fits its channels (name one with --profile)");
    throw Error(ExitCode::usage, path + ": the profiles " + list_of_names(ids, "and") +
                                     " fit alike (name one with --profile, or as 'profile' in capture.json)");
}

}  // namespace aftershade
