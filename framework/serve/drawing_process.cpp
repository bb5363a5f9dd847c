#include "framework/serve/drawing_process.h"

#include <charconv>
#include <utility>

namespace aftershade::serve {

DrawingProcess::DrawingProcess(RunDrawer run, Start begin) : run_(std::move(run)) {
    if (begin == Start::now) start();
}

DrawingProcess::~DrawingProcess() {
    rest();
}

void DrawingProcess::rest() {
    if (socket_.get() >= 0) end();
}

void DrawingProcess::start() {
    auto [mine, theirs] = make_socket_pair();
    socket_ = std::move(mine);
    // The other end closes with the process, and not before: what reads here then learns of it.
    thread_ = std::thread([this, other = std::move(theirs)]() mutable {
        try {
            end_ = run_(other.get());
        } catch (const Error& error) {
            end_ = {error.what(), "", false, error.kind()};
        }
        other.reset();
    });
    const std::optional<Response> ready = receive_answer(socket_.get());
    if (!ready) {
        const DrawerEnd ended = end();
        throw Error(ended.kind, "the process that draws does not start: " + ended.reason);
    }
    if (ready->status == 200) return;
    int kind = int(ErrorKind::gl);
    std::from_chars(ready->type.data(), ready->type.data() + ready->type.size(), kind);
    end();
    throw Error(ErrorKind(kind), ready->body);
}

DrawerEnd DrawingProcess::end() {
    socket_.reset();  // which a process that still works takes as its end
    thread_.join();
    return std::exchange(end_, {});
}

Response DrawingProcess::draw(const DrawRequest& request) {
    if (socket_.get() < 0) start();
    if (send_request(socket_.get(), request))
        if (auto answer = receive_answer(socket_.get())) return std::move(*answer);
    throw end();
}

}  // namespace aftershade::serve
