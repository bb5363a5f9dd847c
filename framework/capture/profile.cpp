#include "framework/capture/profile.h"

#include <algorithm>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/text.h"
#include "framework/capture/channel_names.h"
#include "framework/capture/common_names.h"
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

/// How alike a channel's name and the one looked for are.
enum class Spelling { exact, any_case, canonical };

/// The channel that goes by the name; "" where none does.
std::string channel_called(const ExrPart& part, const std::string& name, Spelling spelling) {
    const std::string canonical = canonical_name(name);
    const auto is_it = [&](const std::string& one) {
        switch (spelling) {
            case Spelling::exact: return one == name || matches_pattern(one, name);
            case Spelling::any_case: return lower_case(one) == lower_case(name);
            default: return !canonical.empty() && canonical_name(one) == canonical;
        }
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
                          Spelling spelling) {
    for (const std::string& pattern : split_alternatives(alternatives))
        if (const std::string name = channel_called(part, with_layer(pattern, layer), spelling);
            !name.empty())
            return name;
    return "";
}

std::optional<FoundChannels> find_in(const RoleDecoding& decoding, const std::string& layer,
                                     const ExrPart& part, Spelling spelling) {
    FoundChannels found;
    for (const auto& names : decoding.layers) {
        auto& components = found.emplace_back();
        for (std::string pattern : names) {
            const bool optional = pattern.ends_with('?');
            if (optional) pattern.pop_back();
            components.push_back(first_present(pattern, layer, part, spelling));
            if (components.back().empty() && !optional) return std::nullopt;
        }
    }
    return found;
}

/// The layer of a channel that ends in `ending`, ".Combined.R", or in another spelling of it; "" for others.
std::string layer_before(const std::string& channel, const std::string& ending) {
    const auto last_component = [](const std::string& of) {
        return of.size() - (of.find_last_of("._- ") + 1);
    };
    const std::string name = canonical_name(channel), wanted = "." + canonical_name(ending);
    if (name.size() <= wanted.size() || !name.ends_with(wanted)) return "";
    // The component alone is of another length.
    const std::size_t length = wanted.size() - last_component(wanted) + last_component(channel);
    return channel.substr(0, channel.size() - length);
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
    for (const Spelling spelling : {Spelling::exact, Spelling::any_case, Spelling::canonical})
        if (auto found = find_in(decoding, layer, part, spelling)) return found;
    return std::nullopt;
}

std::vector<std::string> find_layers(const Profile& profile, const ExrPart& part) {
    std::vector<std::string> layers;
    const auto color = profile.roles.find(kColorRole);
    if (color == profile.roles.end() || color->second.layers.empty()) return layers;
    for (const std::string& pattern : split_alternatives(color->second.layers[0][0])) {
        if (!pattern.starts_with(kLayer)) continue;
        for (const ExrChannel& channel : part.channels)
            if (const std::string layer = layer_before(channel.name, pattern.substr(kLayer.size()));
                !layer.empty() && std::find(layers.begin(), layers.end(), layer) == layers.end())
                layers.push_back(layer);
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

/// One that names its layers, where another program has changed the marks between the words of its names.
const Profile* profile_of_rewritten(const std::vector<Profile>& profiles, const ExrPart& part) {
    for (const Profile& profile : profiles) {
        const auto names_layer = [](const std::string& name) { return name.starts_with(kLayer); };
        RoleDecoding wanted;
        wanted.layers = {profile.detect_channels};
        if (!profile.detect_channels.empty() && std::ranges::all_of(profile.detect_channels, names_layer) &&
            find_in(wanted, find_layer(profile, part), part, Spelling::canonical))
            return &profile;
    }
    return nullptr;
}

}  // namespace

ProfileChoice detect_profile(const std::vector<Profile>& profiles, const ExrPart& part,
                             const std::string& path, bool has_declared_color) {
    const Profile* const native = profile_called(profiles, "native");
    if (native && has_native_names(part)) return {native, "attribute aftershade/channels"};
    std::vector<ProfileChoice> by_attribute, by_channels;
    std::string plain;  // what fits native
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
        const auto found = find_in(wanted, find_layer(profile, part), part, Spelling::exact);
        if (!found) continue;
        // Every picture may have native's names, so that any name of a producer says more.
        if (&profile == native) {
            plain = "channel " + found->front().back();
            continue;
        }
        if (profile.detect_channels.size() < most_channels) continue;
        // A profile that asks for more of what is there says more of where the file comes from.
        if (profile.detect_channels.size() > most_channels) by_channels.clear();
        most_channels = profile.detect_channels.size();
        by_channels.push_back({&profile, "channel " + found->front().back()});
    }
    leave_out_rewriters(by_attribute);
    if (by_channels.empty() && !plain.empty()) by_channels.push_back({native, plain});
    // An attribute is one producer's own mark; channel names are shared by several.
    const auto& fitting = by_attribute.empty() ? by_channels : by_attribute;
    if (fitting.size() == 1) return fitting.front();
    if (native && has_declared_color) return {native, "capture.json names the channels of color"};
    std::vector<std::string> ids;
    for (const ProfileChoice& choice : fitting) ids.push_back(choice.profile->id);
    if (const Profile* const other = fitting.empty() ? profile_of_rewritten(profiles, part) : nullptr)
        return {other, "its names in another spelling"};
    if (fitting.empty() && native && find_common_color(part, ""))
        return {native, "no producer's mark, but a plain colour"};
    if (fitting.empty())
        throw Error(ErrorKind::capture,
                    path + ": no profile fits its channels, " + printable(channel_list(part)) +
                        " (name one with " + spelled(Option::profile) +
                        ", or name the channels of each role as \"channels\": "
                        "{\"color\": {\"channels\": [\"NAME\", \"NAME\", \"NAME\"]}} in capture.json)");
    throw Error(ErrorKind::usage, path + ": the profiles " + list_of_names(ids, "and") +
                                      " fit alike (name one with " + spelled(Option::profile) +
                                      ", or as 'profile' in capture.json)");
}

}  // namespace aftershade
