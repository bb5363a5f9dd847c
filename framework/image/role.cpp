#include "framework/image/role.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

#include "framework/base/text.h"
#include "framework/image/step_role.h"

namespace aftershade {

namespace {

constexpr std::string_view kLayer = "layer";

std::string layer_prefix(int layer) {
    return std::string(kLayer) + std::to_string(layer);
}

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

std::vector<ChannelRole> make_step_roles() {
    const auto make = [](std::string_view name, int channels, bool filterable, float outside, RoleKind kind,
                         const char* meaning) {
        const std::string text{name};
        return ChannelRole{text,
                           channels,
                           ComponentType::float32,
                           filterable,
                           outside,
                           layer(text, std::string_view("RGBA").substr(0, std::size_t(channels))),
                           filterable ? PixelType::half : PixelType::float32,
                           meaning,
                           kind};
    };
    return {make(kLightChangeRole, 3, true, 1, RoleKind::coverage,
                 "light on a surface over that of the frame before; 1 where that is unknown"),
            make(kForegroundRole, 4, true, 0, RoleKind::light,
                 "light spread by a lens from surfaces in front of what a pixel shows, premultiplied"),
            make(kForegroundPlaceRole, 4, false, 0, RoleKind::coverage,
                 "px from the pixel to where foreground comes from, and to a pixel of the surface behind")};
}

const std::vector<ChannelRole>& step_roles() {
    static const std::vector<ChannelRole> table = make_step_roles();
    return table;
}

}  // namespace

std::span<const ChannelRole> channel_roles() {
    return roles();
}

bool is_step_role(std::string_view name) {
    return std::ranges::any_of(step_roles(), [&](const ChannelRole& role) { return role.name == name; });
}

std::optional<ChannelRole> find_role(const RoleId& id) {
    const std::string& name = id.name();
    for (const ChannelRole& role : roles())
        if (role.name == name) return role;
    for (const ChannelRole& role : step_roles())
        if (role.name == name) return role;
    if (id.is_coverage())
        return ChannelRole{name,
                           1,
                           ComponentType::float32,
                           true,
                           0,
                           {name},
                           PixelType::half,
                           "share that objects cover, 0 to 1",
                           RoleKind::coverage};
    if (id.layer() >= 0) {
        std::optional<ChannelRole> role = find_role(id.of_any_layer());
        if (!role) return std::nullopt;
        role->name = name;
        for (std::string& channel : role->native_channels) channel = layer_prefix(id.layer()) + "." + channel;
        return role;
    }
    constexpr std::string_view kAov = "aov:";
    if (name.starts_with(kAov) && name.size() > kAov.size())
        return ChannelRole{name,
                           4,
                           ComponentType::float32,
                           true,
                           0,
                           layer(name.substr(kAov.size()), "RGBA"),
                           PixelType::half,
                           "passed through"};
    return std::nullopt;
}

std::vector<std::string> role_names() {
    std::vector<std::string> names;
    for (const ChannelRole& role : roles()) names.push_back(role.name);
    return names;
}

std::vector<RoleId> role_ids(std::span<const std::string> names) {
    return {names.begin(), names.end()};
}

RoleId::RoleId(std::string name) : name_(std::move(name)) {
    const std::size_t colon = name_.find(':');
    if (!name_.starts_with(kLayer) || colon == std::string::npos) return;
    int layer = -1;
    const char* const end = name_.data() + colon;
    const auto read = std::from_chars(name_.data() + kLayer.size(), end, layer);
    constexpr int kMost = std::numeric_limits<int>::max() - 1;  // layers are counted, from 1
    if (read.ec != std::errc() || read.ptr != end || layer < 0 || layer > kMost) return;
    layer_ = layer;
    layer_prefix_ = colon + 1;
}

RoleId RoleId::coverage(std::span<const TableKey> objects) {
    assert(!objects.empty());
    std::vector<std::string> entries;
    for (const TableKey& key : objects) entries.push_back(format_object_keys({&key, 1}));
    RoleId role("coverage of " + joined(entries, ", "));
    role.objects_.assign(objects.begin(), objects.end());
    return role;
}

RoleId RoleId::of_layer(int layer, std::string_view role) {
    return layer_prefix(layer) + ":" + std::string(role);
}

bool is_blended(RoleKind kind) {
    return kind == RoleKind::light || kind == RoleKind::coverage || kind == RoleKind::other;
}

RoleKind kind_of_role(const RoleId& id) {
    const auto role = find_role(id);
    return role ? role->kind : RoleKind::other;
}

}  // namespace aftershade
