// In which space the colours of a frame are stored.
#include "framework/capture/capture_internal.h"
#include "framework/image/role.h"

namespace aftershade {

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
