#include "framework/batch/object_area.h"

#include <algorithm>

#include "framework/base/data_path.h"
#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/capture.h"
#include "framework/capture/sequence.h"
#include "framework/image/role.h"

namespace aftershade {

AreaShape object_area(const std::string& capture, std::optional<int> frame,
                      const std::vector<TableKey>& objects, const ReadLimits& limits) {
    Diagnostics diagnostics;
    std::optional<Sequence> sequence = open_sequence(capture, diagnostics);
    std::vector<Profile> profiles = read_profiles(data_path() / "profiles", diagnostics);
    if (!sequence || diagnostics.has_errors()) throw Error(ErrorKind::capture, diagnostics);
    if (!frame && sequence->frames.size() != 1)
        throw Error(ErrorKind::capture, capture + ": has " + std::to_string(sequence->frames.size()) +
                                            " frames; name the file of one of them");
    const bool named = std::ranges::any_of(objects, [](const TableKey& key) { return !key.name.empty(); });
    const CaptureReader reader(*sequence, std::move(profiles), limits);
    const RoleId role = RoleId::coverage(objects);
    const Capture read = reader.read(sequence->file_number(frame.value_or(sequence->frames.front())),
                                     std::vector<RoleId>{role});
    if (!named && !std::ranges::count(read.header.roles, kObjectIdRole))
        throw Error(ErrorKind::capture, read.header.path.string() +
                                            ": has no object ids: neither a Cryptomatte nor the " +
                                            "role object_id");
    AreaShape shape =
        covered_area(read.images.at(role), 0, read.header.data_window, read.header.display_window);
    if (!read.header.differences.empty())
        shape.note = read.header.path.string() + ": " + joined(read.header.differences, "; ", "; ");
    return shape;
}

std::string object_area_name(const std::vector<TableKey>& objects) {
    std::string text;
    for (const TableKey& key : objects) text += (text.empty() ? "" : ", ") + object_text(key);
    return text;
}

}  // namespace aftershade
