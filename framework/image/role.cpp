#include "framework/image/role.h"

#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

#include "framework/base/text.h"
#include "framework/document/document.h"
#include "framework/image/step_role.h"

namespace aftershade {

namespace {

constexpr std::string_view kCoverage = "coverage:";
constexpr std::string_view kLayer = "layer";

std::vector<std::string> layer(const std::string& name, std::string_view components) {
    std::vector<std::string> channels;
    for (const char c : components) channels.push_back(name + "." + c);
    return channels;
}

std::vector<ChannelRole> make_roles() {
    constexpr float kNothingHit = std::numeric_limits<float>::infinity();
    using enum RoleKind;
    const auto real = ComponentType::float32;
    const auto rgb = [&](const char* name, bool is_share, const char* meaning) {
        return ChannelRole{name,    3,     real,  true,    0, layer(name, "RGB"), PixelType::half,
                           meaning, light, false, is_share};
    };
    const auto xyz = [&](const char* name, RoleKind kind, bool filterable, const char* meaning) {
        return ChannelRole{name,    3,   real, filterable, 0, layer(name, "XYZ"), PixelType::float32,
                           meaning, kind};
    };
    const auto xy = [&](const char* name, bool to_next, const char* meaning) {
        return ChannelRole{name,    2,      real,   false, 0, layer(name, "XY"), PixelType::float32,
                           meaning, motion, to_next};
    };
    const auto one = [&](const char* name, RoleKind kind, const char* channel, PixelType stored,
                         const char* meaning) {
        const bool is_id = kind == id, is_distance = kind == distance;
        return ChannelRole{name,
                           1,
                           is_id ? ComponentType::uint32 : real,
                           !is_id && !is_distance,
                           is_distance ? kNothingHit : 0,
                           {channel},
                           stored,
                           meaning,
                           kind};
    };
    return {
        {kColorRole,
         4,
         real,
         true,
         0,
         {"R", "G", "B", "A"},
         PixelType::half,
         "scene-linear RGB with premultiplied alpha",
         light},
        one(kDepthRole, distance, "Z", PixelType::float32,
            "distance along the view axis, m; +inf where nothing was hit"),
        xy("velocity", false, "px per frame, current minus previous position, +x right, +y down"),
        xy("velocity_next", true, "px per frame, next minus current position, +x right, +y down"),
        rgb("irradiance", false, "E / pi without albedo: color = albedo * irradiance + the rest"),
        rgb("albedo", true, "scene-linear diffuse reflectance"),
        rgb("specular", false, "scene-linear light that albedo does not colour"),
        rgb("emission", false, "scene-linear emitted light"),
        xyz("normal", direction, true, "world space, unit vector"),
        xyz("position", place, false, "world space, m"),
        one(kObjectIdRole, id, "object_id.I", PixelType::uint32, "unsigned integer"),
        one(kMaskRole, coverage, "mask.V", PixelType::half, "0 to 1"),
        {kDisplayRole, 4, real, true, 0, layer(kDisplayRole, "RGBA"), PixelType::half,
         "display-referred RGB, encoded, 0 to 1, with straight alpha, as PNG has it", display},
    };
}

const std::vector<ChannelRole>& roles() {
    static const std::vector<ChannelRole> table = make_roles();
    return table;
}

}  // namespace

std::span<const ChannelRole> channel_roles() {
    return roles();
}

std::optional<ChannelRole> find_role(std::string_view name) {
    for (const ChannelRole& role : roles())
        if (role.name == name) return role;
    if (name == kLightChangeRole)
        return ChannelRole{std::string(name),
                           3,
                           ComponentType::float32,
                           true,
                           0,
                           layer(std::string(name), "RGB"),
                           PixelType::half,
                           "light on a surface over that of the frame before; 1 where that is unknown",
                           RoleKind::coverage};
    if (is_coverage_role(name))
        return ChannelRole{std::string(name),
                           1,
                           ComponentType::float32,
                           true,
                           0,
                           {std::string(name)},
                           PixelType::half,
                           "share that objects cover, 0 to 1",
                           RoleKind::coverage};
    if (const RoleOfLayer of = split_layer_role(name); of.layer >= 0) {
        std::optional<ChannelRole> role = find_role(of.role);
        if (!role) return std::nullopt;
        role->name = name;
        for (std::string& channel : role->native_channels)
            channel = std::string(kLayer) + std::to_string(of.layer) + "." + channel;
        return role;
    }
    constexpr std::string_view kAov = "aov:";
    if (name.starts_with(kAov) && name.size() > kAov.size()) {
        const std::string aov(name.substr(kAov.size()));
        return ChannelRole{
            std::string(name), 4, ComponentType::float32, true, 0, layer(aov, "RGBA"), PixelType::half,
            "passed through"};
    }
    return std::nullopt;
}

std::vector<std::string> role_names() {
    std::vector<std::string> names;
    for (const ChannelRole& role : roles()) names.push_back(role.name);
    return names;
}

std::string coverage_role(std::span<const TableKey> objects) {
    std::vector<std::string> entries;
    for (const TableKey& key : objects) entries.push_back(format_object_keys(std::span(&key, 1)));
    return std::string(kCoverage) + "[" + joined(entries, ", ") + "]";
}

bool is_coverage_role(std::string_view name) {
    return name.starts_with(kCoverage);
}

std::vector<TableKey> objects_of_coverage(std::string_view role) {
    Diagnostics unused;  // it is our own text
    std::vector<TableKey> objects;
    if (const auto list = parse_document(std::string(role.substr(kCoverage.size())), "", unused))
        for (const Node& entry : list->items)
            for (TableKey& key : parse_object_keys(entry, "", unused)) objects.push_back(std::move(key));
    return objects;
}

std::string layer_role(int layer, std::string_view role) {
    return std::string(kLayer) + std::to_string(layer) + ":" + std::string(role);
}

RoleOfLayer split_layer_role(std::string_view name) {
    const std::size_t colon = name.find(':');
    const RoleOfLayer whole{-1, std::string(name)};
    if (!name.starts_with(kLayer) || colon == std::string_view::npos) return whole;
    int layer = -1;
    const char* const end = name.data() + colon;
    const auto read = std::from_chars(name.data() + kLayer.size(), end, layer);
    if (read.ec != std::errc() || read.ptr != end || layer < 0) return whole;
    return {layer, std::string(name.substr(colon + 1))};
}

bool is_blended(RoleKind kind) {
    return kind == RoleKind::light || kind == RoleKind::coverage || kind == RoleKind::other;
}

RoleKind kind_of_role(std::string_view name) {
    const auto role = find_role(name);
    return role ? role->kind : RoleKind::other;
}

}  // namespace aftershade
