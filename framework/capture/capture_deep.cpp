// The layers of deep captures.
#include <utility>

#include "framework/capture/capture_internal.h"
#include "framework/capture/layer_roles.h"
#include "framework/image/role.h"

namespace aftershade {

bool CaptureReader::is_deep(const OpenFrame& open, const std::string& role) {
    const auto found = open.roles.find(role);
    if (found == open.roles.end() || found->second.channels.empty()) return false;
    for (const std::vector<std::string>& layer : found->second.channels)
        for (const std::string& channel : layer)
            if (!channel.empty()) return found->second.file->deep_part_of(channel) != nullptr;
    return false;
}

/// The deep part of color, else of depth.
DeepPart* CaptureReader::deep_picture(const OpenFrame& open) {
    for (const char* role : {kColorRole, kDepthRole}) {
        if (!is_deep(open, role)) continue;
        const RoleSource& source = open.roles.at(role);
        return source.file->deep_part_of(source.channels.front().front());
    }
    return nullptr;
}

void CaptureReader::read_deep_layers(OpenFrame& open, std::span<const RoleId> roles, Capture& capture) const {
    DeepPart* const picture = deep_picture(open);
    if (!picture) return;
    const int layers = open.header.layer_roles.empty() ? 0 : picture->layers();
    for (open.layer = 0; open.layer < layers; ++open.layer) {
        std::vector<RoleId> deep = roles_of_layer(roles, open.layer);
        std::erase_if(deep, [&](const RoleId& role) { return !is_deep(open, role.name()); });
        Capture of_layer;  // what is said of motion and alpha is said of the whole picture
        of_layer.header = open.header;
        read_images(open, deep, of_layer);
        for (auto& [role, image] : of_layer.images)
            capture.images[RoleId::of_layer(open.layer, role.name())] = std::move(image);
    }
    open.layer = -1;
    capture.deep = picture->reduction();
    if (const std::uint64_t nan = capture.deep->nan_pixels; nan > 0) {
        const auto width = std::size_t(picture->width());
        NonFinitePixels& found = capture.non_finite[kDepthRole];
        found.nan = std::size_t(nan);
        found.x = int(capture.deep->first_nan % width), found.y = int(capture.deep->first_nan / width);
    }
    capture.deep_layers = picture->layers();
}

}  // namespace aftershade
