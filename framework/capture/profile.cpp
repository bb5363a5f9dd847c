#include "framework/capture/profile.h"

#include <algorithm>

#include "framework/core/error.h"
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

bool has_channel(const ExrPart& part, const std::string& name) {
    return std::any_of(part.channels.begin(), part.channels.end(),
                       [&](const auto& c) { return c.name == name; });
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

}  // namespace

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
    const auto color = profile.roles.find(kColorRole);
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

bool matches_pattern(const std::string& name, const std::string& pattern) {
    const std::size_t star = pattern.find('*');
    if (star == std::string::npos) return name == pattern;
    if (name.substr(0, star) != pattern.substr(0, star)) return false;
    const std::string rest = pattern.substr(star + 1);
    for (std::size_t at = star; at <= name.size(); ++at)
        if (matches_pattern(name.substr(at), rest)) return true;
    return false;
}

ProfileChoice detect_profile(const std::vector<Profile>& profiles, const ExrPart& part,
                             const std::string& path) {
    const std::vector<std::string> attributes = part.metadata.names();
    std::vector<ProfileChoice> by_attribute, by_channels;
    std::size_t most_channels = 1;
    for (const Profile& profile : profiles) {
        for (const std::string& pattern : profile.detect_attributes) {
            const auto fits = [&](const std::string& name) { return matches_pattern(name, pattern); };
            const auto found = std::find_if(attributes.begin(), attributes.end(), fits);
            if (found == attributes.end()) continue;
            by_attribute.push_back({&profile, "attribute " + *found});
            break;
        }
        RoleDecoding wanted;
        wanted.layers = {profile.detect_channels};
        const auto found = find_channels(wanted, find_layer(profile, part), part);
        if (!found || profile.detect_channels.size() < most_channels) continue;
        // A profile that asks for more of what is there says more of where the file comes from.
        if (profile.detect_channels.size() > most_channels) by_channels.clear();
        most_channels = profile.detect_channels.size();
        by_channels.push_back({&profile, "channel " + found->front().back()});
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
