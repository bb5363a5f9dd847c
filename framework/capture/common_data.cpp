#include "framework/capture/common_data.h"

#include <algorithm>
#include <set>
#include <vector>

#include "framework/capture/channel_names.h"
#include "framework/capture/common_names.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

using Words = std::vector<std::string>;

/// What a role's channels are called: a layer of one of the words, and its components. A layer of one
/// component may go without it ("" among them). Rare words are those of the producer's own layers ("P.Z" is
/// of a position), so that they count in the colour's layer and above it only.
struct CommonNames {
    std::string_view role;
    Words words, rare_words;
    std::vector<Words> components;
};

const std::vector<CommonNames>& common_names() {
    static const std::vector<Words> kOne = {{"z"}, {"v"}, {"r"}, {"x"}, {"y"}, {""}};
    static const std::vector<Words> kThree = {{"x", "y", "z"}, {"r", "g", "b"}};
    static const std::vector<CommonNames> kNames = {
        {kDepthRole, {"depth", "zdepth", "z.depth", "vrayzdepth"}, {"z", "pz"}, kOne},
        {"normal", {"normal", "normals"}, {"n"}, kThree},
        {"position", {"position", "positions"}, {"p"}, kThree},
        {kObjectIdRole,
         {"object.id", "objectid", "object.index", "indexob"},
         {},
         {{"i"}, {"x"}, {"v"}, {"r"}, {"y"}, {""}}},
    };
    return kNames;
}

std::string joined_name(const std::string& layer, const std::string& rest) {
    return layer.empty() || rest.empty() ? layer + rest : layer + "." + rest;
}

/// The channel of exactly that canonical name, "" for none. What is a colour in CIE XYZ is no depth, and the
/// Z beside X and Y of a layer is that layer's.
std::string channel_of(const ExrPart& part, const std::string& canonical) {
    for (const ExrChannel& channel : part.channels)
        if (canonical_name(channel.name) == canonical && !is_tristimulus(part, channel.name))
            return channel.name;
    return "";
}

std::optional<FoundChannels> find_in_layer(const ExrPart& part, const CommonNames& names,
                                           const std::string& layer, const Words& words) {
    for (const std::string& word : words)
        for (const Words& components : names.components) {
            if (names.role == kDepthRole && word == "z" && components[0].empty() && !layer.empty() &&
                !channel_of(part, layer + ".x").empty())
                continue;
            std::vector<std::string> found;
            for (const std::string& component : components)
                found.push_back(channel_of(part, joined_name(joined_name(layer, word), component)));
            if (std::ranges::find(found, "") == found.end()) return FoundChannels{found};
        }
    return std::nullopt;
}

/// In whichever layer they lie, if there is one such layer alone.
std::optional<FoundChannels> find_anywhere(const ExrPart& part, const CommonNames& names) {
    std::set<std::string> layers;
    for (const ExrChannel& channel : part.channels) {
        const std::string name = canonical_name(channel.name);
        for (const std::string& word : names.words)
            for (const Words& components : names.components)
                if (const std::string ending = "." + joined_name(word, components[0]); name.ends_with(ending))
                    layers.insert(name.substr(0, name.size() - ending.size()));
    }
    // "z.depth.r" ends in "depth.r", too.
    std::optional<FoundChannels> only;
    for (const std::string& layer : layers) {
        const auto found = find_in_layer(part, names, layer, names.words);
        if (found && only && *found != *only) return std::nullopt;
        if (found) only = found;
    }
    return only;
}

}  // namespace

std::optional<FoundChannels> find_common_data(const ExrPart& part, std::string_view role,
                                              const std::string& layer, const std::string& color_channel) {
    const auto names = std::ranges::find(common_names(), role, &CommonNames::role);
    if (names == common_names().end()) return std::nullopt;
    Words words = names->words;
    words.insert(words.end(), names->rare_words.begin(), names->rare_words.end());
    const std::string top = canonical_name(layer);
    std::string at = canonical_name(split_channel_name(color_channel).layer);
    if (!top.empty() && !(at + ".").starts_with(top + ".")) at = top;
    while (true) {
        if (const auto found = find_in_layer(part, *names, at, words)) return found;
        if (at == top) break;
        const std::size_t dot = at.rfind('.');
        at.resize(dot == std::string::npos ? 0 : dot);
    }
    return layer.empty() ? find_anywhere(part, *names) : std::nullopt;
}

}  // namespace aftershade
