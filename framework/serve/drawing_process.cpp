#include "framework/serve/drawing_process.h"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

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

namespace {

using Message = nlohmann::json;

bool send_bytes(int socket, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno != EINTR) return false;
        if (sent > 0) bytes.remove_prefix(std::size_t(sent));
    }
    return true;
}

bool receive_bytes(int socket, char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t got = ::recv(socket, bytes, size, MSG_WAITALL);
        if (got == 0 || (got < 0 && errno != EINTR)) return false;
        if (got > 0) {
            bytes += got;
            size -= std::size_t(got);
        }
    }
    return true;
}

/// A head that says what the body is, and the body, each behind its size.
bool send_message(int socket, const Message& head, std::string_view body) {
    // CBOR (RFC 8949), because a look's text need not be UTF-8.
    std::string bytes;
    Message::to_cbor(head, bytes);
    const std::array<std::uint64_t, 2> sizes = {bytes.size(), body.size()};
    bytes.insert(0, reinterpret_cast<const char*>(sizes.data()), sizeof sizes);
    return send_bytes(socket, bytes) && send_bytes(socket, body);
}

/// nullopt too where the other process was damaged so far that it sends what no message is.
std::optional<Message> receive_message(int socket, std::string& body) {
    constexpr std::uint64_t kMaxHeadBytes = 16 << 20, kMaxBodyBytes = std::uint64_t(1) << 30;
    std::array<std::uint64_t, 2> sizes{};
    if (!receive_bytes(socket, reinterpret_cast<char*>(sizes.data()), sizeof sizes)) return std::nullopt;
    if (sizes[0] > kMaxHeadBytes || sizes[1] > kMaxBodyBytes) return std::nullopt;
    std::string head(sizes[0], '\0');
    body.resize(sizes[1]);
    if (!receive_bytes(socket, head.data(), head.size())) return std::nullopt;
    if (!receive_bytes(socket, body.data(), body.size())) return std::nullopt;
    Message json = Message::from_cbor(head, true, false);
    if (!json.is_object()) return std::nullopt;
    return std::make_optional(std::move(json));
}

}  // namespace

// Without what goes as the body.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DrawRequest, kind, capture, files, revision, effects_revision, frame,
                                   scale, view, exposure_ev, is_file, continues, x, y, truth)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Response, status, type, headers)

bool send_request(int socket, const DrawRequest& request) {
    return send_message(socket, request, request.text);
}

std::optional<DrawRequest> receive_request(int socket) {
    DrawRequest request;
    const auto json = receive_message(socket, request.text);
    if (!json) return std::nullopt;
    json->get_to(request);
    return request;
}

bool send_answer(int socket, const Response& answer) {
    return send_message(socket, answer, answer.body);
}

std::optional<Response> receive_answer(int socket) {
    Response answer;
    const auto json = receive_message(socket, answer.body);
    if (!json) return std::nullopt;
    try {
        json->get_to(answer);
    } catch (const Message::exception&) {
        return std::nullopt;
    }
    return answer;
}

}  // namespace aftershade::serve
