#include "framework/capture/bare_channels.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

#include "framework/capture/channel_names.h"
#include "framework/capture/common_data.h"
#include "framework/capture/common_names.h"

namespace aftershade {

namespace {

bool is_bare_color(std::string_view name) {
    constexpr std::string_view kComponents = "RGBA";
    return name.size() == 1 && kComponents.find(char(std::toupper(static_cast<unsigned char>(name[0])))) !=
                                   std::string_view::npos;
}

/// "mvec.R|R?" without R: "mvec.R?".
std::string without_bare_alternatives(const std::string& alternatives) {
    const bool is_optional = alternatives.ends_with('?');
    const std::size_t length = alternatives.size() - (is_optional ? 1 : 0);
    std::string kept;
    for (std::size_t start = 0; start <= length;) {
        const std::size_t end = std::min(alternatives.find('|', start), length);
        const std::string one = alternatives.substr(start, end - start);
        if (!is_bare_color(one)) kept += (kept.empty() ? "" : "|") + one;
        start = end + 1;
    }
    return kept + (is_optional ? "?" : "");
}

std::string layer_of_channel(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string::npos ? "" : channel.substr(0, dot);
}

/// What a file of one role may call its channels, by their number.
std::vector<std::vector<std::string>> usual_names(int channels) {
    switch (channels) {
        case 2: return {{"R", "G"}, {"X", "Y"}, {"u", "v"}};
        case 3: return {{"R", "G", "B"}, {"X", "Y", "Z"}};
        default: return {{"R", "G", "B", "A?"}};
    }
}

}  // namespace

RoleDecoding without_bare_names(RoleDecoding decoding) {
    for (auto& names : decoding.layers)
        for (std::string& alternatives : names) alternatives = without_bare_alternatives(alternatives);
    return decoding;
}

bool has_one_layer(const ExrPart& part) {
    return !part.channels.empty() &&
           std::all_of(part.channels.begin(), part.channels.end(), [&](const ExrChannel& channel) {
               return layer_of_channel(channel.name) == layer_of_channel(part.channels.front().name);
           });
}

std::optional<FoundChannels> find_only_channels(const ChannelRole& role, const ExrPart& part) {
    if (role.channels == 1) {
        if (part.channels.size() == 1) return FoundChannels{{part.channels.front().name}};
        return find_common_data(part, role.name, "", "");
    }
    if (!has_one_layer(part)) return find_common_data(part, role.name, "", "");
    const std::string layer = layer_of_channel(part.channels.front().name);
    for (std::vector<std::string> names : usual_names(role.channels)) {
        for (std::string& name : names) name = "{layer}." + name;
        RoleDecoding usual;
        usual.layers = {names};
        if (auto found = find_channels(usual, layer, part)) return found;
    }
    return std::nullopt;
}

std::string no_channels_for_role(const ChannelRole& role, const ExrPart& part, bool are_named) {
    std::string names = "\"NAME\"";
    for (int i = 1; i < role.channels; ++i) names += ", \"NAME\"";
    const std::string has = " (it has " + channel_list(part);
    if (are_named) return "does not have the channels that capture.json names for " + role.name + has + ")";
    return "which channel is " + role.name + " is not known" + has +
           "; name it in capture.json: \"channels\": {\"" + role.name + "\": {\"channels\": [" + names +
           "]}})";
}

}  // namespace aftershade
