// In which space the colours of a frame are stored. Irradiance of files that store the light which a surface
// reflects: over the albedo it is what reaches it.
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

namespace {

const std::string& first_channel(const std::string& luminance, const FoundChannels& channels) {
    if (!luminance.empty()) return luminance;
    for (const std::string& name : channels.front())
        if (!name.empty()) return name;
    return channels.front().front();
}

}  // namespace

/// What the user or the profile declares holds for every colour. Else each role's own file says it, and of a
/// file that says nothing the colours are in the space of `color`.
void CaptureReader::find_colors(OpenFrame& open) const {
    CaptureHeader& header = open.header;
    const auto of_file = [&](const RoleSource& source) {
        const std::string& channel = first_channel(source.luminance, source.channels);
        return stored_colors(source.file->merged().metadata, source.file->metadata_of(channel));
    };
    const auto color = open.roles.find(kColorRole);
    const bool has_color =
        color != open.roles.end() && !(color->second.channels.empty() && color->second.luminance.empty());
    StoredColors& colors = header.stored_colors;
    const bool is_called_xyz =
        has_color && !color->second.channels.empty() && color->second.channels[0][0] == "X";
    if (sequence_.color_space != "auto")
        colors = declared_colors(sequence_.color_space, "declared by the user");
    else if (open.profile->color_space != "auto")
        colors = declared_colors(open.profile->color_space, "the profile " + open.profile->id);
    else if (has_color) colors = of_file(color->second);
    else colors = stored_colors(open.main->merged().metadata, open.main->merged().metadata);
    if (is_called_xyz && !colors.is_declared)
        colors = {{kXyz, ColorEncoding::Curve::linear, 1}, "CIE XYZ", "the channels X, Y and Z", false, {}};
    // XYZ has no primaries that light could have: effects see it as Rec. 709.
    header.primaries = is_xyz(colors.encoding.primaries) ? kRec709 : colors.encoding.primaries;
    header.warnings.insert(header.warnings.end(), colors.warnings.begin(), colors.warnings.end());
    for (auto& [role, source] : open.roles) {
        if (kind_of_role(role) != RoleKind::light || source.from_cryptomatte) continue;
        source.colors = colors;
        if (role == kColorRole || colors.is_declared) continue;
        // Beside tristimulus values, what is called R, G and B has primaries that no attribute names.
        if (is_called_xyz) source.colors.encoding = {header.primaries, ColorEncoding::Curve::linear, 1};
        if (StoredColors own = of_file(source); source.file != open.main.get() && own.is_known())
            source.colors = std::move(own);
    }
}

}  // namespace aftershade
