// Captures from files, alone and in sequences.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "aftershade/capture.h"
#include "framework/base/text.h"
#include "framework/capture/capture_window.h"
#include "framework/host/host_data.h"
#include "framework/host/image_data.h"

namespace aftershade::host {

namespace {

constexpr int kMaxDivisor = 64;

void check_choice(const char* option, const std::string& value, std::vector<std::string> known,
                  Diagnostics& faults) {
    known.insert(known.begin(), "auto");
    if (std::find(known.begin(), known.end(), value) == known.end())
        faults.error({std::string("CaptureOptions::") + option},
                     "'" + value + "' is not " + list_of_names(known) + did_you_mean(value, known));
}

void check_capture_options(Host::Data& host, const CaptureOptions& options) {
    Diagnostics faults;
    std::vector<std::string> profiles;
    for (const Profile& profile : host.profiles()) profiles.push_back(profile.id);
    check_choice("profile", options.profile, profiles, faults);
    check_choice("color_space", options.color_space, color_space_names(), faults);
    for (const std::string& role : options.roles)
        if (!find_role(role))
            faults.error({"CaptureOptions::roles"},
                         "'" + role + "' is not a role" + did_you_mean(role, role_names()));
    if (options.scale_divisor < 1 || options.scale_divisor > kMaxDivisor)
        faults.error({"CaptureOptions::scale_divisor"},
                     fmt::format("{} is not from 1 to {}", options.scale_divisor, kMaxDivisor));
    stop_at_errors(ErrorKind::usage, faults);
}

}  // namespace

std::shared_ptr<const Sequence::Data> open_sequence_data(Host::Data& host, const std::filesystem::path& path,
                                                         const CaptureOptions& options,
                                                         std::vector<std::string> object_names) {
    check_capture_options(host, options);
    Diagnostics faults;
    auto sequence = open_sequence(path.string(), faults);
    stop_at_errors(ErrorKind::document, faults);
    auto data = std::make_shared<Sequence::Data>();
    data->sequence = std::move(*sequence);
    aftershade::Sequence& opened = data->sequence;
    // "auto" leaves what a capture.json says.
    if (options.profile != "auto") opened.profile = options.profile;
    if (options.color_space != "auto") opened.color_space = options.color_space;
    if (!options.view.empty()) opened.view = options.view;
    if (!options.layer.empty()) opened.layer = options.layer;
    if (options.alpha_is_opaque) opened.alpha_is_opaque = true;
    opened.object_names = std::move(object_names);
    data->profiles = host.profiles();
    data->limits = {host.options.limits.max_side_px, host.options.limits.max_image_bytes};
    data->options = options;
    data->reader = std::make_unique<CaptureReader>(opened, data->profiles, data->limits);
    return data;
}

Capture read_capture(const Sequence::Data& data, int frame, int subframe, const std::vector<RoleId>& roles) {
    const int file = data.sequence.file_number(frame, subframe);
    Capture::Data capture;
    capture.capture = roles.empty() ? data.reader->read(file, data.reader->read_header(file).roles)
                                    : data.reader->read(file, roles);
    scale_capture(capture.capture, data.options.scale_divisor);
    capture.capture.header.frame = frame;
    capture.scale = 1.0 / data.options.scale_divisor;
    return Access::capture(std::move(capture));
}

Capture Capture::read(const Host& host, const std::filesystem::path& path, const CaptureOptions& options) {
    return called(Access::host(host), [&] {
        const auto sequence = open_sequence_data(Access::host(host), path, options);
        return read_capture(*sequence, sequence->sequence.frames.front(), 0, role_ids(options.roles));
    });
}

Sequence::Sequence(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
Sequence::Sequence(const Sequence&) noexcept = default;
Sequence& Sequence::operator=(const Sequence&) noexcept = default;
Sequence::~Sequence() = default;

Sequence Sequence::open(const Host& host, const std::filesystem::path& path, const CaptureOptions& options) {
    return called(Access::host(host), [&] {
        return Access::make<Sequence>(open_sequence_data(Access::host(host), path, options));
    });
}

std::vector<int> Sequence::frames() const {
    return data_->sequence.frames;
}
double Sequence::fps() const noexcept {
    return data_->sequence.fps;
}
int Sequence::subframes() const noexcept {
    return data_->sequence.subframes;
}
std::vector<int> Sequence::cuts() const {
    return data_->sequence.cuts;
}

Capture Sequence::read(int frame, int subframe) const {
    return with_public_errors([&] {
        const auto& frames = data_->sequence.frames;
        if (std::find(frames.begin(), frames.end(), frame) == frames.end())
            fail_at(ErrorKind::usage, "frame", fmt::format("the sequence has no frame {}", frame));
        if (subframe < 0 || subframe >= data_->sequence.subframes)
            fail_at(ErrorKind::usage, "subframe",
                    fmt::format("{} is not from 0 to {}", subframe, data_->sequence.subframes - 1));
        return read_capture(*data_, frame, subframe, role_ids(data_->options.roles));
    });
}

}  // namespace aftershade::host
