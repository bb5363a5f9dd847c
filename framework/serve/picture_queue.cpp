#include "framework/serve/picture_queue.h"

#include <chrono>
#include <exception>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"

namespace aftershade::serve {

namespace {

/// Not an error: it is what the newest of many requests is meant to do, and browsers log each error that they
/// get.
Response superseded() {
    return {204, "", ""};
}

std::string remedy(const DrawerEnd& end) {
    return "; change the look or the shader" +
           (end.is_hang ? advice(", or allow more time with ", Option::pass_timeout, "", "") : "");
}

/// Whether no page waits for `older` any longer once it asks for `newer`.
bool replaces(const DrawRequest& newer, const DrawRequest& older) {
    using Kind = DrawRequest::Kind;
    return newer.kind == Kind::picture && older.kind == Kind::picture && newer.view == older.view &&
           newer.is_file == older.is_file && (newer.scale == older.scale || older.revision < newer.revision);
}

}  // namespace

PictureQueue::PictureQueue(RunDrawer run, Listener listener, const std::atomic<bool>& stop, Start start)
    : listener_(std::move(listener)),
      stop_(stop),
      start_(start),
      process_(std::move(run), start),
      thread_([this] { loop(); }) {}

PictureQueue::~PictureQueue() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        for (const auto& task : tasks_) task->reply(superseded());
        tasks_.clear();
        waiting_.notify_all();
    }
    thread_.join();
}

void PictureQueue::loop() {
    while (const std::unique_ptr<Task> task = next()) task->reply(answer(task->request));
}

std::unique_ptr<PictureQueue::Task> PictureQueue::next() {
    constexpr auto kRestAfter = std::chrono::minutes(1);
    std::unique_lock lock(mutex_);
    for (;;) {
        const auto has_work = [&] { return ends_ || !tasks_.empty(); };
        if (start_ == Start::at_first_use && !waiting_.wait_for(lock, kRestAfter, has_work)) {
            lock.unlock();
            process_.rest();
            lock.lock();
        }
        waiting_.wait(lock, has_work);
        if (ends_) return nullptr;
        if (!stop_) break;
        for (const auto& task : tasks_) task->reply(superseded());
        tasks_.clear();
    }
    std::unique_ptr<Task> task = std::move(tasks_.front());
    tasks_.pop_front();
    return task;
}

void PictureQueue::note(const DrawRequest& request, const Response& response) {
    if (response.status != 200 || request.kind != DrawRequest::Kind::picture || request.scale != 1) return;
    if (response.headers.contains(kFaultHeader)) return;
    listener_.drawn(request);
    if (request.view != "final" || request.is_file) return;
    const std::lock_guard lock(mutex_);
    last_final_ = response;
}

std::optional<Response> PictureQueue::last_final() const {
    const std::lock_guard lock(mutex_);
    return last_final_;
}

/// What ends the process once may be chance, such as memory that another program took. What ends it twice is
/// the look, or a shader of it, and would end it for ever. A pass that takes too long is not tried again.
Response PictureQueue::answer(const DrawRequest& request) {
    if (given_up_ && given_up_->text == request.text &&
        given_up_->effects_revision == request.effects_revision)
        return error_response(409, given_up_->reason);
    constexpr int kAttempts = 2;
    for (int attempt = 1;; ++attempt) {
        try {
            Response response = process_.draw(request);
            note(request, response);
            return response;
        } catch (const DrawerEnd& end) {
            if (stop_) return superseded();
            if (attempt < kAttempts && !end.is_hang) continue;
            const std::string reason = end.reason + remedy(end);
            given_up_ = {request.text, request.effects_revision, reason};
            listener_.given_up(request, {reason, end.step});
            return error_response(409, reason);
        } catch (const std::exception& error) {
            return fault_response(error);
        }
    }
}

void PictureQueue::drop_older(const DrawRequest& request) {
    tasks_.remove_if([&](const std::unique_ptr<Task>& task) {
        const bool is_older = replaces(request, task->request);
        if (is_older) task->reply(superseded());
        return is_older;
    });
}

void PictureQueue::run(DrawRequest request, Reply reply) {
    constexpr std::size_t kMost = 64;  // each with a look's text of up to 1 MiB
    const std::lock_guard lock(mutex_);
    if (ends_) return reply(superseded());
    drop_older(request);
    if (tasks_.size() >= kMost)
        return reply(error_response(503, "64 pictures wait, the most that may; send it again"));
    tasks_.push_back(std::make_unique<Task>(Task{std::move(request), std::move(reply)}));
    waiting_.notify_one();
}

}  // namespace aftershade::serve
