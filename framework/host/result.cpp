#include <algorithm>
#include <utility>

#include "aftershade/look.h"
#include "framework/host/failures.h"
#include "framework/host/rendering.h"
#include "framework/run/output.h"

namespace aftershade::host {

const FrameResult& Access::frame(const Result& result) {
    return *result.data_->frame;
}

Result::Result(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
Result::Result(const Result&) noexcept = default;
Result& Result::operator=(const Result&) noexcept = default;
Result::~Result() = default;

int Result::frame() const noexcept {
    return data_->capture->header.frame;
}
bool Result::is_pending() const noexcept {
    return data_->is_pending;
}
std::vector<std::string> Result::roles() const {
    return data_->is_pending ? std::vector<std::string>{} : data_->roles;
}

Image Result::image(const std::string& role) const {
    const auto& roles = data_->roles;
    if (data_->is_pending || std::find(roles.begin(), roles.end(), role) == roles.end())
        fail_at(ErrorKind::usage, role,
                data_->is_pending ? "a sub-frame before the last has no images"
                                  : "the frame was rendered without this role in RenderOptions::roles, or "
                                    "into a texture");
    const auto made = data_->frame->images.find(role);
    if (made != data_->frame->images.end())
        return Access::image(std::shared_ptr<const aftershade::Image>(data_->frame, &made->second));
    const aftershade::Image& captured = data_->capture->images.at(role);
    if (captured.empty())
        fail_at(ErrorKind::usage, role, "no step made this image, and the capture's is a texture");
    return Access::image(std::shared_ptr<const aftershade::Image>(data_->capture, &captured));
}

std::vector<std::string> Result::taps() const {
    std::vector<std::string> names;
    for (const auto& [name, image] : data_->frame->taps) names.push_back(name);
    return names;
}

Image Result::tap(const std::string& name) const {
    const auto found = data_->frame->taps.find(name);
    if (found == data_->frame->taps.end())
        fail_at(ErrorKind::usage, name,
                "no such tap" + did_you_mean(name, taps()) + " (see LookOptions::taps)");
    return Access::image(std::shared_ptr<const aftershade::Image>(data_->frame, &found->second));
}

std::vector<PassTime> Result::times() const {
    std::vector<PassTime> times;
    if (data_->is_timed)
        for (const graph::PassTime& time : data_->frame->times)
            times.push_back({time.pass, time.milliseconds});
    return times;
}

std::vector<StatisticInfo> Result::statistics() const {
    std::vector<StatisticInfo> all;
    if (!data_->frame->telemetry) return all;
    for (const auto& [step, statistics] : data_->frame->telemetry->steps)
        for (const auto& [name, s] : statistics)
            all.push_back({step, name, s.count, s.non_finite, s.sum, s.mean, s.deviation, s.min, s.max,
                           s.from, s.to, s.histogram});
    return all;
}

std::vector<NonFiniteInfo> Result::non_finite() const {
    return data_->non_finite;
}
std::vector<std::string> Result::messages() const {
    return data_->frame->messages;
}
std::vector<std::string> Result::notes() const {
    return notes_of(data_->capture->header);
}
std::string Result::history_reset() const {
    return data_->frame->history_reset;
}
std::uint64_t Result::gpu_bytes() const noexcept {
    return data_->gpu_bytes;
}
void* Result::fence() const noexcept {
    return data_->fence;
}

void Result::write(const std::filesystem::path& path, const WriteOptions& options) const {
    with_public_errors([&] {
        if (data_->is_pending) fail(ErrorKind::usage, "a sub-frame before the last has no images to write");
        OutputOptions outputs;
        outputs.patterns = {path.string()};
        outputs.roles = options.roles;
        outputs.color_type = options.half ? PixelType::half : PixelType::float32;
        outputs.crop_to_display = options.crop_to_display;
        outputs.compression = options.compression;
        outputs.renderer = data_->renderer;
        aftershade::Sequence sequence;
        sequence.frames = {frame()};
        InputFiles inputs;
        inputs.add(data_->capture->header.path);
        inputs.add(*data_->documents);
        Diagnostics faults;
        check_outputs(outputs, sequence, inputs, faults);
        stop_at_errors(ErrorKind::usage, faults);
        for (const std::string& role : wanted_roles(outputs)) {
            const auto captured = data_->capture->images.find(role);
            if (captured != data_->capture->images.end() && captured->second.empty() &&
                !data_->frame->images.contains(role))
                fail_at(ErrorKind::usage, role, "this image is on the GPU and was not read back");
        }
        const CaptureReader unused(sequence, {}, {});
        FrameResult result;
        result.images = data_->frame->images;
        result.display_encoding = data_->frame->display_encoding;
        result.color_encoding = data_->frame->color_encoding;
        write_outputs(outputs, result, *data_->capture, unused);
    });
}

}  // namespace aftershade::host
