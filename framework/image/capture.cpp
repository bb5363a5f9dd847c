#include "framework/image/capture.h"

#include <algorithm>
#include <utility>

#include "framework/core/error.h"
#include "framework/image/decode.h"
#include "framework/image/role.h"

namespace aftershade {

struct CaptureReader::OpenFrame {
    ExrFile file;
    CaptureHeader header;
    const Profile* profile = nullptr;
    std::string layer;
};

CaptureReader::CaptureReader(const Sequence& sequence, std::vector<Profile> profiles, ReadLimits limits)
    : sequence_(sequence), profiles_(std::move(profiles)), limits_(limits) {}

CaptureReader::OpenFrame CaptureReader::open(int frame) const {
    OpenFrame open{ExrFile(sequence_.path_of(frame), limits_), {}, nullptr, {}};
    const ExrPart& part = open.file.parts().front();
    CaptureHeader& header = open.header;
    header.frame = frame;
    header.path = open.file.path();
    header.data_window = part.data_window;
    header.display_window = part.display_window;
    header.pixel_aspect = part.pixel_aspect;
    header.metadata = part.metadata;
    header.camera = sequence_.camera;
    for (const ExrChannel& channel : part.channels) header.channels.push_back(channel.name);

    if (sequence_.profile == "auto") {
        const ProfileChoice choice = detect_profile(profiles_, part, header.path.string());
        open.profile = choice.profile;
        header.profile_reason = choice.reason;
    } else {
        const auto found = std::find_if(profiles_.begin(), profiles_.end(),
                                        [&](const Profile& p) { return p.id == sequence_.profile; });
        if (found == profiles_.end()) {
            std::vector<std::string> ids;
            for (const Profile& profile : profiles_) ids.push_back(profile.id);
            throw Error(ExitCode::usage, "no profile '" + sequence_.profile + "'; known: " + list_of_names(ids, "and"));
        }
        open.profile = &*found;
        header.profile_reason = "chosen by name";
    }
    header.profile = open.profile->id;
    open.layer = find_layer(*open.profile, part);
    for (const auto& [role, decoding] : open.profile->roles)
        if (find_channels(decoding, open.layer, part)) header.roles.push_back(role);
    return open;
}

CaptureHeader CaptureReader::read_header(int frame) const { return open(frame).header; }

Capture CaptureReader::read(int frame, std::span<const std::string> roles) const {
    OpenFrame open = this->open(frame);
    Capture capture;
    for (const std::string& name : roles) {
        const auto decoding = open.profile->roles.find(name);
        if (decoding == open.profile->roles.end()) continue;
        const auto channels = find_channels(decoding->second, open.layer, open.file.parts().front());
        if (!channels) continue;
        capture.images[name] = decode_role(open.file, 0, *find_role(name), decoding->second, *channels);
    }
    capture.header = std::move(open.header);
    return capture;
}

}  // namespace aftershade
