#include "framework/compare/layer.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "framework/base/text.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

constexpr std::array<std::string_view, 7> kRoleNames = {"color",    "display", "alpha", "depth",
                                                        "velocity", "id",      "data"};

std::string component_of(const std::string& channel) {
    return channel.substr(channel.rfind('.') + 1);  // npos + 1 is 0
}

std::string prefix_of(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string::npos ? "" : channel.substr(0, dot);
}

/// Whether one of the words between dots is among `words`: views and view layers stand before or after the
/// name of the pass ("ViewLayer.Vector", "forward.left").
bool has_word(const std::string& name, const std::set<std::string>& words) {
    std::size_t begin = 0;
    while (begin <= name.size()) {
        const std::size_t end = std::min(name.find('.', begin), name.size());
        if (words.contains(lower_case(name.substr(begin, end - begin)))) return true;
        begin = end + 1;
    }
    return false;
}

const std::set<std::string> kVelocityWords = {
    "velocity_prev", "vector",         "vectors", "motion",   "motionvector", "motionvectors",
    "motion_vector", "motion_vectors", "forward", "backward", "speed",        "mv"};
const std::set<std::string> kDepthWords = {"z"};
const std::set<std::string> kIdWords = {"id", "objectid", "material_id", "indexob", "indexma"};
const std::set<std::string> kDataWords = {"normals", "n", "worldpos", "p", "uv"};

/// How a layer that holds a role of this kind is compared.
LayerRole layer_role_of(RoleKind kind) {
    switch (kind) {
        case RoleKind::light: return LayerRole::color;
        case RoleKind::distance: return LayerRole::depth;
        case RoleKind::motion: return LayerRole::velocity;
        case RoleKind::id: return LayerRole::id;
        case RoleKind::display: return LayerRole::display;
        case RoleKind::direction:
        case RoleKind::place:
        case RoleKind::coverage:
        case RoleKind::other: break;
    }
    return LayerRole::data;
}

/// Words in a layer's name that say it is a `layer`: other producers', and our own roles that are compared
/// so.
std::set<std::string> words_of(LayerRole layer, std::set<std::string> words = {}) {
    for (const ChannelRole& role : channel_roles())
        if (layer_role_of(role.kind) == layer) words.insert(role.name);
    return words;
}

bool is_cryptomatte(const std::string& name) {
    return lower_case(name).find("crypto") != std::string::npos;
}

/// Where the component stands in its layer; those that are not in the list keep the file's order.
std::size_t rank(const std::string& channel) {
    static const std::vector<std::string> order = {"r", "red", "x",    "u", "g", "green", "y",
                                                   "v", "b",   "blue", "z", "a", "alpha", "w"};
    return std::size_t(std::ranges::find(order, lower_case(component_of(channel))) - order.begin());
}

bool is_color_component(const std::string& component) {
    static const std::set<std::string> names = {"r", "g", "b", "red", "green", "blue"};
    return names.contains(lower_case(component));
}

bool is_alpha_component(const std::string& component) {
    const std::string name = lower_case(component);
    return name == "a" || name == "alpha";
}

/// Components of a vector. A lone z is a distance, so it is not among them.
bool is_vector_component(const std::string& component) {
    static const std::set<std::string> names = {"x", "y", "w", "u", "v"};
    return names.contains(lower_case(component));
}

/// What the layers of a part share.
struct PartNames {
    std::string part;                  ///< "" of a file's only one
    std::set<std::string> with_color;  ///< prefixes that have colours
    bool has_vector = false;           ///< X and Y without a prefix
};

/// Which layer of its prefix a channel belongs to.
std::string group_of(const ExrChannel& channel, const std::string& prefix, const PartNames& names) {
    const std::string component = component_of(channel.name);
    const bool has_color = names.with_color.contains(prefix);
    // Read as floats, integers above 2^24 would lose their last bits.
    if (channel.type == PixelType::uint32) return "id";
    if (is_cryptomatte(prefix.empty() ? names.part : prefix)) return "cryptomatte";
    if (is_color_component(component)) return "color";
    if (is_alpha_component(component) && (has_color || prefix.empty())) return "alpha";
    if (!prefix.empty()) return "";
    const std::string name = lower_case(component);
    if (names.has_vector && (is_vector_component(component) || name == "z")) return "";
    if (name == "z") return "depth";
    if (name == "y" && !has_color) return "color";  // luminance alone
    return component;
}

LayerRole role_of(const LayerInfo& layer) {
    if (layer.group == "alpha") return LayerRole::alpha;
    if (layer.group == "depth") return LayerRole::depth;
    if (layer.group == "id" || layer.group == "cryptomatte") return LayerRole::id;
    const std::string& own = layer.name.empty() ? layer.part : layer.name;
    const std::string& name = own.empty() ? layer.group : own;
    const std::size_t count = layer.channels.size();
    static const std::set<std::string> velocity = words_of(LayerRole::velocity, kVelocityWords),
                                       depth = words_of(LayerRole::depth, kDepthWords),
                                       ids = words_of(LayerRole::id, kIdWords),
                                       data = words_of(LayerRole::data, kDataWords),
                                       display = words_of(LayerRole::display);
    if (has_word(name, velocity) && count >= 2) return LayerRole::velocity;
    if (has_word(name, depth) && count == 1) return LayerRole::depth;
    if (has_word(name, ids) && count == 1) return LayerRole::id;
    if (count == 1 && lower_case(component_of(layer.channels[0])) == "z" && !has_word(name, data))
        return LayerRole::depth;  // of a view: "left.Z"
    if (layer.group != "color" || has_word(name, data)) return LayerRole::data;
    return has_word(name, display) ? LayerRole::display : LayerRole::color;
}

}  // namespace

std::string_view layer_role_name(LayerRole role) {
    return kRoleNames[std::size_t(role)];
}

std::optional<LayerRole> find_layer_role(std::string_view name) {
    const auto found = std::ranges::find(kRoleNames, name);
    if (found == kRoleNames.end()) return std::nullopt;
    return LayerRole(found - kRoleNames.begin());
}

std::vector<std::string> layer_role_names() {
    return {kRoleNames.begin(), kRoleNames.end()};
}

bool is_perceptual(LayerRole role) {
    return role == LayerRole::color || role == LayerRole::display;
}

std::string LayerInfo::label() const {
    std::string text = part.empty() ? "" : part + ":";
    if (!name.empty()) text += name + ".";
    const auto is_short = [](const std::string& channel) { return component_of(channel).size() == 1; };
    const bool joined = std::ranges::all_of(channels, is_short);
    for (std::size_t i = 0; i < channels.size(); ++i)
        text += (joined || i == 0 ? "" : ",") + component_of(channels[i]);
    return text;
}

std::vector<LayerInfo> layers_of_channels(const std::string& part, std::span<const ExrChannel> channels,
                                          const Window& data_window, const Window& display_window) {
    PartNames names;
    names.part = part;
    const auto has = [&](const char* upper, const char* lower) {
        return std::ranges::any_of(channels, [&](const ExrChannel& channel) {
            return channel.name == upper || channel.name == lower;
        });
    };
    names.has_vector =
        !part.empty() && ((has("X", "x") && has("Y", "y")) || (has("U", "u") && has("V", "v")));
    for (const ExrChannel& channel : channels)
        if (is_color_component(component_of(channel.name))) names.with_color.insert(prefix_of(channel.name));
    std::vector<LayerInfo> layers;
    for (const ExrChannel& channel : channels) {
        LayerInfo layer;
        layer.part = part;
        layer.name = prefix_of(channel.name);
        layer.group = group_of(channel, layer.name, names);
        layer.data_window = data_window;
        layer.display_window = display_window;
        layer.type = channel.type == PixelType::uint32 ? ComponentType::uint32 : ComponentType::float32;
        const auto known = std::ranges::find(layers, layer.key(), &LayerInfo::key);
        LayerInfo& target = known == layers.end() ? layers.emplace_back(std::move(layer)) : *known;
        target.channels.push_back(channel.name);
        if (channel.type == PixelType::half) target.stored = kStoredHalf;
    }
    for (LayerInfo& layer : layers) {
        std::ranges::stable_sort(layer.channels, {}, rank);
        layer.role = role_of(layer);
    }
    return layers;
}

}  // namespace aftershade
