#include "framework/inspect/velocity_frames.h"

#include <array>
#include <cstddef>
#include <utility>

#include "framework/base/error.h"
#include "framework/image/role.h"
#include "framework/image/window.h"
#include "framework/inspect/velocity_check.h"

namespace aftershade {

namespace {

VelocitySettings settings_of(const ChannelRole& role, const std::map<std::string, RoleDecoding>& decodings) {
    constexpr std::array kDeltas = {"cur-prev", "prev-cur", "next-cur", "cur-next"};
    constexpr std::array kUnits = {"px", "uv", "ndc"};
    VelocitySettings settings;
    if (role.to_next) settings.delta = "next-cur";
    const auto found = decodings.find(role.name);
    if (found == decodings.end()) return settings;
    const RoleDecoding& decoding = found->second;
    settings.delta = kDeltas[std::size_t(decoding.delta)];
    settings.y_axis = decoding.y_axis_up ? "up" : "down";
    settings.unit = kUnits[std::size_t(decoding.unit)];
    settings.scale = {decoding.velocity_scale[0], decoding.velocity_scale[1]};
    settings.bias = double(decoding.bias);
    settings.shutter_frames = decoding.shutter_frames;
    return settings;
}

const Image* on_display(Capture& capture, const std::string& role) {
    const auto image = capture.images.find(role);
    if (image == capture.images.end()) return nullptr;
    image->second = place_in_window(std::move(image->second), capture.header.data_window,
                                    capture.header.display_window, 0);
    return &image->second;
}

const Image* color_on_display(Capture& capture, const char* name) {
    const Image* const color = on_display(capture, kColorRole);
    const std::string path = capture.header.path.string();
    if (!color) throw Error(ErrorKind::capture, (path.empty() ? name : path) + ": has no color to compare");
    return color;
}

}  // namespace

std::vector<std::string> velocity_check_roles() {
    std::vector<std::string> roles = {kColorRole};
    for (const ChannelRole& role : channel_roles())
        if (role.kind == RoleKind::motion) roles.push_back(role.name);
    return roles;
}

std::vector<RoleVelocityCheck> check_velocity_of_frames(
    Capture a, Capture b, const std::map<std::string, RoleDecoding>& decodings) {
    const Image* const color_a = color_on_display(a, "the first frame");
    const Image* const color_b = color_on_display(b, "the second frame");
    std::vector<RoleVelocityCheck> checks;
    for (const ChannelRole& role : channel_roles()) {
        if (role.kind != RoleKind::motion) continue;
        const Image* const vectors_a = on_display(a, role.name);
        const Image* const vectors_b = on_display(b, role.name);
        if (!vectors_a && !vectors_b) continue;
        checks.push_back({role.name, check_velocity({color_a, color_b, vectors_a, vectors_b,
                                                     settings_of(role, decodings), a.header.primaries})});
    }
    return checks;
}

}  // namespace aftershade
