#include "framework/image/role.h"

#include <limits>

namespace aftershade {

namespace {

std::vector<std::string> layer(const std::string& name, std::string_view components) {
    std::vector<std::string> channels;
    for (const char c : components) channels.push_back(name + "." + c);
    return channels;
}

std::vector<ChannelRole> make_roles() {
    constexpr float kNothingHit = std::numeric_limits<float>::infinity();
    const auto real = ComponentType::float32;
    const auto rgb = [&](const char* name, const char* meaning) {
        return ChannelRole{name, 3, real, true, 0, layer(name, "RGB"), PixelType::half, meaning};
    };
    const auto xyz = [&](const char* name, bool filterable, const char* meaning) {
        return ChannelRole{name, 3, real, filterable, 0, layer(name, "XYZ"), PixelType::float32, meaning};
    };
    const auto xy = [&](const char* name, const char* meaning) {
        return ChannelRole{name, 2, real, false, 0, layer(name, "XY"), PixelType::float32, meaning};
    };
    return {
        {"color",
         4,
         real,
         true,
         0,
         {"R", "G", "B", "A"},
         PixelType::half,
         "scene-linear RGB with premultiplied alpha"},
        {"depth",
         1,
         real,
         false,
         kNothingHit,
         {"Z"},
         PixelType::float32,
         "distance along the view axis, m; +inf where nothing was hit"},
        xy("velocity", "px per frame, current minus previous position, +x right, +y down"),
        xy("velocity_next", "px per frame, next minus current position, +x right, +y down"),
        rgb("irradiance", "E / pi without albedo: color = albedo * irradiance + the rest"),
        rgb("albedo", "scene-linear diffuse reflectance"),
        rgb("specular", "scene-linear light that albedo does not colour"),
        rgb("emission", "scene-linear emitted light"),
        xyz("normal", true, "world space, unit vector"),
        xyz("position", false, "world space, m"),
        {"object_id",
         1,
         ComponentType::uint32,
         false,
         0,
         {"object_id.I"},
         PixelType::uint32,
         "unsigned integer"},
        {"mask", 1, real, true, 0, {"mask.V"}, PixelType::half, "0 to 1"},
        {"display",
         4,
         real,
         true,
         0,
         {"display.R", "display.G", "display.B", "display.A"},
         PixelType::half,
         "display-referred RGB, encoded, 0 to 1, with straight alpha, as PNG has it"},
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
    if (name.starts_with("aov:") && name.size() > 4) {
        const std::string aov(name.substr(4));
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

}  // namespace aftershade
