#include "framework/serve/render_thread.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "framework/core/error.h"
#include "framework/serve/refusal.h"

namespace aftershade::serve {

namespace {

/// Not an error: it is what the newest of many requests is meant to do, and browsers log each error that they
/// get.
Response superseded() {
    return {204, "", ""};
}

/// Of what the look, its effects and its capture hold, and not of this machine.
bool is_of_documents(ExitCode code) {
    return code == ExitCode::usage || code == ExitCode::capture || code == ExitCode::effect;
}

Response answer_of(const RenderThread::Work& work, PictureMaker& maker) {
    try {
        return work(maker);
    } catch (const Refusal& refusal) {
        return error_response(refusal.status, refusal.message);
    } catch (const Error& error) {
        return error_response(is_of_documents(error.exit_code()) ? 400 : 500, error.what());
    } catch (const std::exception& error) {
        return error_response(500, error.what());
    }
}

}  // namespace

RenderThread::RenderThread(MakeMaker make, const std::atomic<bool>& stop) : stop_(stop) {
    std::promise<void> ready;
    std::future<void> is_ready = ready.get_future();
    thread_ = std::thread([this, make = std::move(make), &ready] { loop(make, ready); });
    try {
        is_ready.get();
    } catch (...) {
        thread_.join();
        throw;
    }
}

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        for (const auto& task : tasks_) task->answer.set_value(superseded());
        tasks_.clear();
        waiting_.notify_all();
    }
    thread_.join();
}

void RenderThread::loop(const MakeMaker& make, std::promise<void>& ready) {
    std::unique_ptr<PictureMaker> maker;
    try {
        maker = make();
    } catch (...) {
        ready.set_exception(std::current_exception());
        return;
    }
    ready.set_value();
    while (const std::unique_ptr<Task> task = next()) task->answer.set_value(answer_of(task->work, *maker));
}

std::unique_ptr<RenderThread::Task> RenderThread::next() {
    std::unique_lock lock(mutex_);
    for (;;) {
        waiting_.wait(lock, [&] { return ends_ || !tasks_.empty(); });
        if (ends_) return nullptr;
        if (!stop_) break;
        for (const auto& task : tasks_) task->answer.set_value(superseded());
        tasks_.clear();
    }
    std::unique_ptr<Task> task = std::move(tasks_.front());
    tasks_.pop_front();
    return task;
}

void RenderThread::drop_older(const PictureKey& key) {
    if (key.view.empty()) return;
    tasks_.remove_if([&](const std::unique_ptr<Task>& task) {
        const bool is_older =
            task->key.view == key.view && (task->key.scale == key.scale || task->key.revision < key.revision);
        if (is_older) task->answer.set_value(superseded());
        return is_older;
    });
}

Response RenderThread::run(const PictureKey& key, Work work) {
    auto task = std::make_unique<Task>(Task{key, std::move(work), {}});
    std::future<Response> answer = task->answer.get_future();
    {
        const std::lock_guard lock(mutex_);
        if (ends_) return superseded();
        drop_older(key);
        tasks_.push_back(std::move(task));
        waiting_.notify_one();
    }
    return answer.get();
}

}  // namespace aftershade::serve
