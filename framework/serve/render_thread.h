// Work for the one thread that owns the GL context, the newest request for a picture before older ones.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "framework/serve/http_message.h"
#include "framework/serve/picture_maker.h"

namespace aftershade::serve {

/// What a picture is of, to find out which ones no page waits for any longer. "" as view: not a picture.
struct PictureKey {
    std::string view;
    int scale = 1;
    std::uint64_t revision = 0;
};

/// [any thread]
class RenderThread {
public:
    using MakeMaker = std::function<std::unique_ptr<PictureMaker>()>;
    using Work = std::function<Response(PictureMaker&)>;

    /// Waits for the context. Throws what `make` throws. Once `stop` is set, no work begins any more.
    RenderThread(MakeMaker make, const std::atomic<bool>& stop);
    ~RenderThread();
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    /// Waits for the answer. A picture of the same view that has not begun is answered with 204 where it is
    /// of the same scale or of an older revision; so is every request after the end.
    Response run(const PictureKey& key, Work work);

private:
    struct Task {
        PictureKey key;
        Work work;
        std::promise<Response> answer;
    };
    void loop(const MakeMaker& make, std::promise<void>& ready);
    void drop_older(const PictureKey& key);
    std::unique_ptr<Task> next();

    const std::atomic<bool>& stop_;
    std::mutex mutex_;  // of what follows
    std::condition_variable waiting_;
    std::list<std::unique_ptr<Task>> tasks_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace aftershade::serve
