// What a frame's compression has altered of its data.
#include "framework/base/diagnostics.h"
#include "framework/capture/capture_internal.h"
#include "framework/file/exr_loss.h"
#include "framework/image/role.h"

namespace aftershade {

/// Pictures are compressed with loss by intent. A depth, a vector or an id that lost bits is another one.
void CaptureReader::find_losses(OpenFrame& open) {
    for (const auto& [role, source] : open.roles) {
        const RoleKind kind = kind_of_role(role);
        if (kind == RoleKind::light || kind == RoleKind::display || kind == RoleKind::other) continue;
        std::vector<std::string> lost;
        std::string compression;
        for (const std::vector<std::string>& layer : source.channels)
            for (const std::string& channel : layer) {
                if (channel.empty()) continue;
                const std::string& stored = source.file->compression_of(channel);
                if (!loses_bits(stored, channel, source.file->type_of(channel))) continue;
                lost.push_back(channel);
                compression = stored;
            }
        if (lost.empty()) continue;
        const bool is_own_file = source.file != open.main.get();
        open.header.warnings.push_back(role + " is read from " + list_of_names(lost, "and") +
                                       (is_own_file ? " of the role's own file" : "") +
                                       ", stored with loss (" + compression +
                                       "): its values are not exact (write them with zip, zips or piz)");
    }
}

}  // namespace aftershade
