#include "framework/capture/common_names.h"

#include <algorithm>
#include <array>
#include <set>

#include "framework/core/text.h"
#include "framework/image/color_space.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

using Components = std::array<const char*, 4>;
constexpr Components kTristimulus = {"X", "Y", "Z", "A"};
constexpr std::array kColorComponents = {Components{"R", "G", "B", "A"}, Components{"r", "g", "b", "a"},
                                         Components{"red", "green", "blue", "alpha"},
                                         Components{"Red", "Green", "Blue", "Alpha"}, kTristimulus};

std::string joined_name(const std::string& layer, const std::string& component) {
    return layer.empty() ? component : layer + "." + component;
}

/// CIE tristimulus values, as Mitsuba writes them. Positions and normals are X, Y and Z of a layer, in files
/// whose chromaticities are those of lights.
bool has_tristimulus(const ExrPart& part, const std::string& layer) {
    return layer.empty() && is_xyz(stored_primaries(part.metadata));
}

/// The channels of the layer's colour; "" for an alpha that is absent.
std::optional<std::vector<std::string>> color_of_layer(const ExrPart& part, const std::string& layer) {
    for (const Components& components : kColorComponents) {
        if (components[0] == kTristimulus[0] && !has_tristimulus(part, layer)) continue;
        std::vector<std::string> names;
        for (const char* component : components) names.push_back(joined_name(layer, component));
        if (!has_channel(part, names[0]) || !has_channel(part, names[1]) || !has_channel(part, names[2]))
            continue;
        if (!has_channel(part, names[3])) names[3].clear();
        return names;
    }
    return std::nullopt;
}

/// What the file's header calls a Cryptomatte has a preview, which looks like a colour.
std::set<std::string> cryptomatte_names(const ExrPart& part) {
    std::set<std::string> names;
    for (const std::string& attribute : part.metadata.names())
        if (attribute.starts_with("cryptomatte/") && attribute.ends_with("/name"))
            names.insert(part.metadata.text(attribute).value_or(""));
    return names;
}

/// By the last word of its name, such as "N" of "beauty.N": a usual one, or a role's.
bool holds_data(const std::string& layer) {
    static const std::set<std::string> words = {
        "n",      "normals", "ng",           "ns",        "normw",   "p",       "positions", "posw",
        "pos",    "z",       "uv",           "st",        "tangent", "id",      "vector",    "vectors",
        "motion", "mvec",    "motionvector", "motionvec", "forward", "backward"};
    if (layer.empty()) return false;
    const std::string word = lower_case(layer.substr(layer.rfind('.') + 1));
    return words.contains(word) || word.find("crypto") != std::string::npos || find_role(word).has_value();
}

/// Of several layers, the one that a person would take for the picture.
std::optional<std::string> usual_layer(const std::vector<std::string>& layers) {
    constexpr std::array kUsual = {"",       "image", "combined", "composite", "rgba",
                                   "beauty", "color", "c",        "ci"};
    for (const char* usual : kUsual)
        for (const std::string& layer : layers)
            if (lower_case(layer.substr(layer.rfind('.') + 1)) == usual) return layer;
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
    for (const ExrChannel& channel : part.channels) {
        const std::size_t dot = channel.name.rfind('.');
        const std::string layer = dot == std::string::npos ? "" : channel.name.substr(0, dot);
        if (std::find(layers.begin(), layers.end(), layer) != layers.end() || holds_data(layer) ||
            mattes.contains(layer) || is_rank(layer))
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

std::optional<FoundChannels> find_common_depth(const ExrPart& part, const std::string& layer) {
    for (const char* name : {"depth.Z", "Depth.Z", "Depth.V", "depth.V", "depth", "Depth", "Z"})
        if (has_channel(part, joined_name(layer, name)) && !is_tristimulus(part, joined_name(layer, name)))
            return FoundChannels{{joined_name(layer, name)}};
    return std::nullopt;
}

bool has_channel(const ExrPart& part, std::string_view name) {
    return std::any_of(part.channels.begin(), part.channels.end(),
                       [&](const ExrChannel& channel) { return channel.name == name; });
}

}  // namespace aftershade
