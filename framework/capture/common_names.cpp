#include "framework/capture/common_names.h"

#include <algorithm>
#include <array>
#include <set>

#include "framework/base/text.h"
#include "framework/capture/channel_names.h"
#include "framework/image/color_space.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

constexpr std::array<const char*, 4> kTristimulus = {"X", "Y", "Z", "A"};

/// The channel that is a component of the layer, in any usual spelling; "" where there is none.
std::string component_of(const ExrPart& part, const std::string& layer, const std::string& component) {
    for (const ExrChannel& channel : part.channels)
        if (split_channel_name(channel.name) == ChannelName{layer, component}) return channel.name;
    return "";
}

/// CIE tristimulus values, as Mitsuba writes them. Positions and normals are X, Y and Z of a layer, in files
/// whose chromaticities are those of lights.
bool has_tristimulus(const ExrPart& part, const std::string& layer) {
    return layer.empty() && is_xyz(stored_primaries(part.metadata));
}

/// The channels of the layer's colour; "" for an alpha that is absent.
std::optional<std::vector<std::string>> color_of_layer(const ExrPart& part, const std::string& layer) {
    std::vector<std::string> names;
    for (const char* component : {"r", "g", "b", "a"}) names.push_back(component_of(part, layer, component));
    if (!names[0].empty() && !names[1].empty() && !names[2].empty()) return names;
    if (!has_tristimulus(part, layer) || !has_x_y_z(part)) return std::nullopt;
    names = {kTristimulus.begin(), kTristimulus.end()};
    if (!has_channel(part, names[3])) names[3].clear();
    return names;
}

/// What the file's header calls a Cryptomatte has a preview, which looks like a colour.
std::set<std::string> cryptomatte_names(const ExrPart& part) {
    std::set<std::string> names;
    for (const std::string& attribute : part.metadata.names())
        if (attribute.starts_with("cryptomatte/") && attribute.ends_with("/name"))
            names.insert(part.metadata.text(attribute).value_or(""));
    return names;
}

/// "combined" of "ViewLayer_Combined".
std::string last_word(const std::string& layer) {
    const std::string name = canonical_name(layer);
    return name.substr(name.rfind('.') + 1);
}

/// By the last word of its name, such as "N" of "beauty.N": a usual one, or a role's.
bool holds_data(const std::string& layer) {
    static const std::set<std::string> words = {
        "n",      "normals", "ng",           "ns",        "normw",   "p",        "positions",    "posw",
        "pos",    "z",       "uv",           "st",        "tangent", "id",       "vector",       "vectors",
        "motion", "mvec",    "motionvector", "motionvec", "forward", "backward", "motionvectors"};
    static const std::set<std::string> last_words = {"normals", "vector", "vectors"};
    if (layer.empty()) return false;
    const std::string word = lower_case(layer.substr(layer.rfind('.') + 1));
    return words.contains(word) || last_words.contains(last_word(layer)) ||
           (find_role(last_word(layer)) && kind_of_role(last_word(layer)) != RoleKind::light) ||
           word.find("crypto") != std::string::npos || find_role(word).has_value();
}

/// Of several layers, the one that a person would take for the picture.
std::optional<std::string> usual_layer(const std::vector<std::string>& layers) {
    constexpr std::array kUsual = {"",       "image", "combined", "composite", "rgba",
                                   "beauty", "color", "c",        "ci"};
    for (const char* usual : kUsual)
        for (const std::string& layer : layers)
            if (lower_case(layer.substr(layer.rfind('.') + 1)) == usual) return layer;
    for (const char* word : {"combined", "composite", "rgba", "beauty"})
        for (const std::string& layer : layers)
            if (last_word(layer) == word) return layer;
    if (layers.size() == 1) return layers.front();
    return std::nullopt;
}

}  // namespace

bool has_layer(const ExrPart& part, const std::string& layer) {
    return std::any_of(part.channels.begin(), part.channels.end(),
                       [&](const ExrChannel& channel) { return channel.name.starts_with(layer + "."); });
}

bool is_tristimulus(const ExrPart& part, const std::string& channel) {
    const bool is_one = channel == "X" || channel == "Y" || channel == "Z";
    return is_one && has_tristimulus(part, "") && has_x_y_z(part) && !has_channel(part, "R");
}

bool has_x_y_z(const ExrPart& part) {
    return has_channel(part, "X") && has_channel(part, "Y") && has_channel(part, "Z");
}

std::vector<std::string> color_layers(const ExrPart& part) {
    const std::set<std::string> mattes = cryptomatte_names(part);
    const auto is_rank = [&](const std::string& layer) {
        return layer.size() > 2 && mattes.contains(layer.substr(0, layer.size() - 2));
    };
    std::vector<std::string> layers;
    std::set<std::string> seen;
    for (const ExrChannel& channel : part.channels) {
        const std::string layer = split_channel_name(channel.name).layer;
        if (!seen.insert(layer).second || holds_data(layer) || mattes.contains(layer) || is_rank(layer))
            continue;
        if (color_of_layer(part, layer)) layers.push_back(layer);
    }
    return layers;
}

std::optional<FoundChannels> find_common_color(const ExrPart& part, const std::string& layer) {
    std::vector<std::string> candidates = color_layers(part);
    if (!layer.empty()) {
        if (const auto own = color_of_layer(part, layer)) return FoundChannels{*own};
        std::erase_if(candidates, [&](const std::string& one) { return !one.starts_with(layer + "."); });
    }
    const auto chosen = usual_layer(candidates);
    if (!chosen) return std::nullopt;
    return FoundChannels{*color_of_layer(part, *chosen)};
}

std::vector<FoundChannels> find_all_common_colors(const ExrPart& part) {
    static const std::set<std::string> kNames = {"", "image", "combined", "composite", "rgba", "beauty"};
    std::vector<FoundChannels> all;
    for (const std::string& layer : color_layers(part)) {
        if (!kNames.contains(canonical_name(layer))) continue;
        std::vector<std::string> names = *color_of_layer(part, layer);
        names.pop_back();
        all.push_back({names});
    }
    return all;
}

std::string find_common_alpha(const ExrPart& part, const std::string& red) {
    const std::string layer = split_channel_name(red).layer;
    if (const std::string own = component_of(part, layer, "a"); !own.empty()) return own;
    // What stands beside another colour is the alpha of that one.
    if (!layer.empty() && component_of(part, "", "r").empty())
        if (const std::string bare = component_of(part, "", "a"); !bare.empty()) return bare;
    const std::string canonical = canonical_name(layer);
    for (const std::string& above : {canonical, canonical.substr(0, canonical.rfind('.') + 1)})
        for (const char* component : {"a", "v", "y", "x", "z", "r"}) {
            const std::string head = above.empty() || above.ends_with('.') ? above : above + ".";
            for (const ExrChannel& channel : part.channels)
                if (canonical_name(channel.name) == head + "alpha." + component) return channel.name;
        }
    return "";
}

bool has_channel(const ExrPart& part, std::string_view name) {
    return std::any_of(part.channels.begin(), part.channels.end(),
                       [&](const ExrChannel& channel) { return channel.name == name; });
}

}  // namespace aftershade
