// The process that draws, seen from the one that speaks HTTP: it is started again when it has ended.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "framework/base/child_process.h"
#include "framework/base/error.h"
#include "framework/serve/draw_messages.h"

namespace aftershade::serve {

/// How a process that draws came to its end.
struct DrawerEnd {
    std::string reason;    ///< "the GL driver crashed (signal 11, SIGSEGV) while drawing pass ..."
    std::string step{};    ///< of the look, whose pass was at work; "" where none was
    bool is_hang = false;  ///< a pass took too long
    ErrorKind kind = ErrorKind::effect;
};

/// Runs a process with `socket` as its standard input, whose work is draw_for(), to its end. It is killed
/// where a pass takes too long, where it takes too much memory, and once the user asked to stop.
using RunDrawer = std::function<DrawerEnd(int socket)>;

/// [one thread at a time]
class DrawingProcess {
public:
    enum class Start { now, at_first_use };
    /// Starts it, and waits for its context. Throws Error where there is none.
    explicit DrawingProcess(RunDrawer run, Start start = Start::now);
    ~DrawingProcess();
    DrawingProcess(const DrawingProcess&) = delete;
    DrawingProcess& operator=(const DrawingProcess&) = delete;

    /// Starts it before where there is none. Throws DrawerEnd where it came to its end over the request, and
    /// Error where it cannot be started.
    Response draw(const DrawRequest& request);
    /// Ends it where there is one, until the next request.
    void rest();

private:
    void start();
    DrawerEnd end();

    RunDrawer run_;
    Descriptor socket_;  // -1: there is no process
    std::thread thread_;
    DrawerEnd end_;  // written by the thread, before it ends
};

}  // namespace aftershade::serve
