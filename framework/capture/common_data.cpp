#include "framework/capture/common_data.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
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

bool lies_in(const std::string& layer, const std::string& top) {
    return top.empty() || layer == top || layer.starts_with(top + ".");
}

/// What a channel may be called by one of the role's words.
struct Naming {
    std::string layer, word;
    std::size_t components = 0;  ///< index
    bool is_rare = false;
};

std::vector<Naming> namings_of(const std::string& name, const CommonNames& names) {
    std::vector<Naming> namings;
    for (const Words* words : {&names.words, &names.rare_words})
        for (const std::string& word : *words)
            for (std::size_t i = 0; i < names.components.size(); ++i)
                if (const std::string ending = joined_name(word, names.components[i][0]);
                    name == ending || name.ends_with("." + ending))
                    namings.push_back({name.substr(0, name.size() - std::min(name.size(), ending.size() + 1)),
                                       word, i, words == &names.rare_words});
    return namings;
}

/// The components beside a channel that is the first of them, in its own spelling where there is one.
std::optional<FoundChannels> components_beside(const ExrPart& part, const std::string& first,
                                               const Words& components) {
    const std::string name = canonical_name(first);
    const std::string head = name.substr(0, name.size() - components[0].size());
    const std::string spelled = first.substr(0, first.find_last_of("._- ") + 1);  // npos + 1 is 0
    std::vector<std::string> found = {first};
    for (std::size_t i = 1; i < components.size(); ++i) {
        std::string& component = found.emplace_back(channel_of(part, head + components[i]));
        for (const ExrChannel& channel : part.channels)
            if (canonical_name(channel.name) == head + components[i] && channel.name.starts_with(spelled))
                component = channel.name;
        if (component.empty()) return std::nullopt;
    }
    return FoundChannels{found};
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

std::vector<FoundChannels> find_all_common_data(const ExrPart& part, std::string_view role,
                                                const std::string& layer, const std::string& color_channel) {
    const auto names = std::ranges::find(common_names(), role, &CommonNames::role);
    if (names == common_names().end()) return {};
    const std::string top = canonical_name(layer);
    const std::string of_color = canonical_name(split_channel_name(color_channel).layer);
    std::vector<std::string> other_pictures;
    for (const std::string& one : color_layers(part))
        if (const std::string name = canonical_name(one); !name.empty() && name != of_color && name != top)
            other_pictures.push_back(name);
    const auto counts = [&](const Naming& naming) {
        const auto is_of = [&](const std::string& picture) { return lies_in(naming.layer, picture); };
        const bool is_of_place =
            naming.word == "z" && !naming.layer.empty() && !channel_of(part, naming.layer + ".x").empty();
        return lies_in(naming.layer, top) && !is_of_place && std::ranges::none_of(other_pictures, is_of) &&
               (!naming.is_rare || naming.layer.empty() || naming.layer == of_color);
    };
    // Of one name in one layer the first of its usual components counts, in whichever spellings.
    std::map<std::pair<std::string, std::string>, std::map<std::size_t, std::vector<FoundChannels>>> found;
    for (const ExrChannel& channel : part.channels) {
        if (is_tristimulus(part, channel.name)) continue;
        for (const Naming& naming : namings_of(canonical_name(channel.name), *names))
            if (const auto all = components_beside(part, channel.name, names->components[naming.components]);
                all && counts(naming))
                found[{naming.layer, naming.word}][naming.components].push_back(*all);
    }
    std::vector<FoundChannels> distinct;
    for (const auto& [name, by_components] : found)
        for (const FoundChannels& one : by_components.begin()->second)
            if (std::ranges::find(distinct, one) == distinct.end()) distinct.push_back(one);
    return distinct;
}

}  // namespace aftershade
