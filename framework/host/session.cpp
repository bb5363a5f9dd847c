// Frames in turn, rendered with what they leave for the next.
#include <memory>
#include <string>
#include <utility>

#include "aftershade/capture.h"
#include "aftershade/look.h"
#include "framework/host/host_data.h"
#include "framework/host/image_data.h"
#include "framework/host/rendering.h"
#include "framework/host/sequence_player.h"

namespace aftershade::host {

struct Session::Data {
    Data(std::shared_ptr<Host::Data> on, std::shared_ptr<const LookCore> of)
        : host(std::move(on)), rendering(host, std::move(of)) {}

    std::shared_ptr<Host::Data> host;
    Rendering rendering;
    std::unique_ptr<SequencePlayer> player;  // of the last sequence
    std::shared_ptr<const Capture::Data> centre;
};

namespace {

Session::Data& required(const std::unique_ptr<Session::Data>& data) {
    if (!data) fail(ErrorKind::usage, "this Session was moved from");
    return *data;
}

Result result_of(Result::Data data) {
    return Access::make<Result>(std::make_shared<const Result::Data>(std::move(data)));
}

}  // namespace

Session Look::session() {
    if (!data_) fail(ErrorKind::usage, "this Look was moved from");
    return called(*data_->host, [&] {
        return Access::make<Session>(std::make_unique<Session::Data>(data_->host, data_->core));
    });
}

Session::Session(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&& other) noexcept {
    Session replaced(std::move(other));
    std::swap(data_, replaced.data_);
    return *this;
}
Session::~Session() {
    if (gpu::is_forked_from_gl()) gpu::leave_to_exit(std::move(data_));  // frames read ahead wait for threads
}

Result Session::render(const Capture& capture, const RenderOptions& options) {
    return render_subframe(capture, 0, 1, options);
}

Result Session::render_subframe(const Capture& capture, int index, int count, const RenderOptions& options) {
    Data& data = required(data_);
    return called(*data.host, [&] {
        if (count < 1 || index < 0 || index >= count)
            fail_at(ErrorKind::usage, "index",
                    "sub-frame " + std::to_string(index) + " of " + std::to_string(count) +
                        "; a frame has at least 1, counted from 0");
        FrameTask task;
        task.capture = Access::share(capture);
        if (index == 0) data.centre.reset();
        if (index == count / 2) data.centre = task.capture;
        if (options.previous) task.previous = Access::share(*options.previous);
        if (options.next) task.next = Access::share(*options.next);
        task.begins_shot = options.begins_shot;
        task.subframe = index;
        task.subframe_count = count;
        task.centre = data.centre;
        return result_of(data.rendering.render(task, options));
    });
}

Result Session::render(const Sequence& sequence, int frame, const RenderOptions& options) {
    Data& data = required(data_);
    return called(*data.host, [&] {
        const auto from = Access::share(sequence);
        if (!data.player || !data.player->plays(from, options.non_finite, data.rendering.look().revision))
            data.player = std::make_unique<SequencePlayer>(data.rendering, from, options.non_finite);
        return result_of(data.player->render(frame, options));
    });
}

void Session::reset() {
    Data& data = required(data_);
    called(*data.host, [&] {
        data.player.reset();
        data.centre.reset();
        data.rendering.drop();
    });
}

void Session::save_history(const std::filesystem::path& path) {
    Data& data = required(data_);
    called(*data.host, [&] { data.rendering.renderer().save_history(path); });
}

void Session::load_history(const std::filesystem::path& path) {
    Data& data = required(data_);
    called(*data.host, [&] { data.rendering.renderer().load_history(path); });
}

}  // namespace aftershade::host
