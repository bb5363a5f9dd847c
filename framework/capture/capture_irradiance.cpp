// Irradiance of files that store the light which a surface reflects: over the albedo it is what reaches it.
#include <algorithm>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/capture_internal.h"
#include "framework/capture/decode.h"
#include "framework/capture/stored_layers.h"
#include "framework/document/units.h"
#include "framework/image/role.h"

namespace aftershade {

/// Without an albedo the light that a surface reflects is not the light that reaches it.
void CaptureReader::require_albedo(OpenFrame& open) const {
    const auto found = open.roles.find(kIrradianceRole);
    if (found == open.roles.end() || !found->second.decoding.times_albedo) return;
    const auto albedo = open.roles.find(kAlbedoRole);
    if (albedo != open.roles.end() && !albedo->second.channels.empty()) return;
    const std::string why =
        "irradiance is " + list_of_names(open.header.role_channels.at(kIrradianceRole), "and") +
        " over the albedo, and the profile '" + open.header.profile +
        "' finds no albedo (render it too, or name its channels or its file as for any role)";
    if (sequence_.channels.contains(kIrradianceRole) || open.role_files.contains(kIrradianceRole))
        throw Error(ErrorKind::capture, open.header.path.string() + ": " + why);
    open.header.half_there[kIrradianceRole] = why;
    open.header.role_channels.erase(kIrradianceRole);
    open.roles.erase(found);
}

/// The roles, and those that irradiance is made of if it is one of them.
std::vector<RoleId> CaptureReader::with_parts_of_irradiance(const OpenFrame& open,
                                                            std::span<const RoleId> roles) {
    std::vector<RoleId> all(roles.begin(), roles.end());
    const auto found = open.roles.find(kIrradianceRole);
    if (found == open.roles.end() || std::ranges::find(all, kIrradianceRole) == all.end()) return all;
    const RoleDecoding& decoding = found->second.decoding;
    if (decoding.times_albedo) all.emplace_back(kAlbedoRole);
    all.insert(all.end(), decoding.plus.begin(), decoding.plus.end());
    return all;
}

/// The sum of the roles to add, as stored; nullopt where the capture has none of them.
std::optional<Image> CaptureReader::read_added_light(const OpenFrame& open, const RoleSource& source) const {
    std::optional<Image> sum;
    for (const std::string& role : source.decoding.plus) {
        const auto found = open.roles.find(role);
        if (found == open.roles.end() || found->second.channels.empty()) continue;
        FoundChannels channels = found->second.channels;  // four, the last of which is no light
        for (auto& names : channels) names.resize(std::size_t(find_role(kIrradianceRole)->channels));
        Image light = read_layers(*found->second.file, channels, open.header.data_window, 0,
                                  {open.layer, is_blended(RoleKind::light)});
        if (!sum) sum = std::move(light);
        else
            for (std::size_t i = 0; i < light.floats().size(); ++i) sum->floats()[i] += light.floats()[i];
    }
    return sum;
}

Image CaptureReader::read_stored_albedo(const OpenFrame& open) const {
    const RoleSource& source = open.roles.at(kAlbedoRole);
    return read_layers(*source.file, source.channels, open.header.data_window, 0,
                       {open.layer, is_blended(RoleKind::light)});
}

void CaptureReader::finish_irradiance(const OpenFrame& open, const RoleSource& source, Image& light,
                                      Capture& capture) const {
    if (const auto added = read_added_light(open, source))
        for (std::size_t i = 0; i < light.floats().size(); ++i) light.floats()[i] += added->floats()[i];
    const float scale = source.decoding.scale;
    if (scale != 1)
        for (float& value : light.floats()) value *= scale;
    if (!source.decoding.times_albedo) return;
    capture.pixels_below_albedo_floor =
        divide_by_albedo(light, read_stored_albedo(open), float(source.decoding.albedo_floor));
    // Without figures, so that a sequence says it once.
    if (capture.pixels_below_albedo_floor > 0)
        capture.header.warnings.push_back(
            "irradiance is less than the light over the albedo where the albedo is below " +
            format_number(source.decoding.albedo_floor) +
            " (\"albedo_floor\" next to the role's channels in capture.json)");
}

}  // namespace aftershade
