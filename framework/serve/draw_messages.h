// Messages between the process that speaks HTTP and the process that draws, over their socket.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

}  // namespace aftershade::serve
