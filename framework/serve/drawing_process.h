// The process that draws, seen from the one that speaks HTTP: it is started again when it has ended. And the
// messages between the two, over their socket.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "framework/base/child_process.h"
#include "framework/base/error.h"
#include "framework/serve/http_message.h"

namespace aftershade::serve {

/// A header of the answer whose picture is the capture's, because a step takes from it what it has not.
inline constexpr const char* kFaultHeader = "X-Aftershade-Fault";

/// What is to be drawn, without anything that only one process has.
struct DrawRequest {
    enum class Kind {
        picture,
        probe,
        histogram,
        metrics,
        thumbnail,  ///< a picture of a text that is not the look's
        starts,     ///< the starting looks, for this frame
        objects     ///< the names of what the frame shows
    };
    Kind kind = Kind::picture;
    std::string capture;             ///< CAPTURE of the command line; "" for the process's own
    std::string text;                ///< of the look
    std::vector<std::string> files;  ///< that it may name, with links followed
    std::uint64_t revision = 0;
    std::uint64_t effects_revision = 0;
    int frame = 0;
    int scale = 1;               ///< the picture has 1/scale of the pixels of each side
    std::string view = "final";  ///< as that of a PictureRequest
    double exposure_ev = 0;
    bool is_file = false;    ///< the picture is the PNG that `run` writes, and not one that is packed quickly
    bool continues = false;  ///< effects with history see the frame before it, where that was drawn last
    int x = 0, y = 0;        ///< of a probe
    std::string truth;       ///< of metrics
};

// Each waits until the whole message is through. false or nullopt: the other process is gone.
bool send_request(int socket, const DrawRequest& request);
std::optional<DrawRequest> receive_request(int socket);
bool send_answer(int socket, const Response& answer);
std::optional<Response> receive_answer(int socket);

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
