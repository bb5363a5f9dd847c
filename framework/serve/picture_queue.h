// Requests to draw, one after the other: the newest request for a picture comes first.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "framework/serve/drawing_process.h"
#include "framework/serve/http_message.h"
#include "framework/serve/look_model.h"

namespace aftershade::serve {

/// [any thread]
class PictureQueue {
public:
    struct Listener {
        /// A picture of the whole size came.
        std::function<void(const DrawRequest&)> drawn;
        /// The process that draws came to its end over this, and over its repetition.
        std::function<void(const DrawRequest&, const Undrawable& why)> given_up;
    };

    using Start = DrawingProcess::Start;
    /// Waits for the context, unless the process starts at its first use: such a process ends after a minute
    /// without a request, too. Throws what DrawingProcess throws. Once `stop` is set, no work begins any
    /// more.
    PictureQueue(RunDrawer run, Listener listener, const std::atomic<bool>& stop, Start start = Start::now);
    ~PictureQueue();
    PictureQueue(const PictureQueue&) = delete;
    PictureQueue& operator=(const PictureQueue&) = delete;

    using Reply = std::function<void(Response)>;
    /// Does not wait: `reply` gets the answer, on any thread. A picture of the same view that has not begun
    /// is answered with 204 where it is of the same scale or of an older revision; so is every request after
    /// the end. Where as many wait as may, 503.
    void run(DrawRequest request, Reply reply);
    /// The final picture of the whole size that came last, for where the look cannot be drawn any more.
    std::optional<Response> last_final() const;

private:
    struct Task {
        DrawRequest request;
        Reply reply;
    };
    struct GivenUp {
        std::string text;
        std::uint64_t effects_revision = 0;
        std::string reason;
    };
    void loop();
    void drop_older(const DrawRequest& request);
    std::unique_ptr<Task> next();
    Response answer(const DrawRequest& request);
    void note(const DrawRequest& request, const Response& response);

    const Listener listener_;
    const std::atomic<bool>& stop_;
    const Start start_;
    DrawingProcess process_;           // the thread's
    std::optional<GivenUp> given_up_;  // the thread's
    mutable std::mutex mutex_;         // of what follows
    std::optional<Response> last_final_;
    std::condition_variable waiting_;
    std::list<std::unique_ptr<Task>> tasks_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace aftershade::serve
