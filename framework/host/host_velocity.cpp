#include "aftershade/velocity.h"

#include <map>
#include <utility>

#include "framework/capture/profile.h"
#include "framework/host/failures.h"
#include "framework/host/host_data.h"
#include "framework/host/image_data.h"
#include "framework/inspect/velocity_frames.h"

namespace aftershade::host {

namespace {

static_assert(int(VelocityVerdict::untestable) == int(aftershade::VelocityVerdict::untestable));

VelocitySettings public_settings(const aftershade::VelocitySettings& settings) {
    return {settings.delta, settings.y_axis, settings.unit, settings.scale, settings.exchange_channels};
}

std::vector<VelocityCheck> checks_of(const aftershade::Capture& frame, const aftershade::Capture& next_frame,
                                     const std::map<std::string, RoleDecoding>& decodings) {
    std::vector<VelocityCheck> checks;
    for (const auto& [role, check] : check_velocity_of_frames(frame, next_frame, decodings))
        checks.push_back({role, VelocityVerdict(int(check.verdict)), check.sentence, check.identity.score,
                          check.rival.score, public_settings(check.settings),
                          public_settings(check.suggested), check.untold, check.longest_px});
    return checks;
}

const aftershade::Capture& in_memory(const Capture& capture) {
    const Capture::Data& data = Access::data(capture);
    for (const std::string& role : velocity_check_roles())
        if (data.has_texture(role))
            fail_at(ErrorKind::usage, role, "this image is a texture, whose pixels are on the GPU");
    return data.capture;
}

}  // namespace

const char* velocity_verdict_name(VelocityVerdict verdict) noexcept {
    switch (verdict) {
        case VelocityVerdict::confirmed: return "confirmed";
        case VelocityVerdict::undecided: return "undecided";
        case VelocityVerdict::wrong: return "wrong";
        case VelocityVerdict::no_fit: return "no_fit";
        case VelocityVerdict::untestable: break;
    }
    return "untestable";
}

std::vector<VelocityCheck> check_velocity(const Host& host, const std::filesystem::path& frame,
                                          const std::filesystem::path& next_frame,
                                          const CaptureOptions& options) {
    Host::Data& data = Access::host(host);
    return called(data, [&] {
        const auto read = [&](const Sequence::Data& from) {
            return Access::data(
                       read_capture(from, from.sequence.frames.front(), 0, role_ids(velocity_check_roles())))
                .capture;
        };
        const auto first = open_sequence_data(data, frame, options);
        const auto second = open_sequence_data(data, next_frame, options);
        second->reader->hold_to_first_of(*first->reader);
        return checks_of(
            read(*first), read(*second),
            second->reader->decodings(second->sequence.file_number(second->sequence.frames.front())));
    });
}

std::vector<VelocityCheck> check_velocity(const Capture& frame, const Capture& next_frame) {
    return with_public_errors([&] { return checks_of(in_memory(frame), in_memory(next_frame), {}); });
}

}  // namespace aftershade::host
