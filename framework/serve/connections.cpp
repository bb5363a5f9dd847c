#include "framework/serve/connections.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <optional>

#include "framework/core/error.h"

namespace aftershade::serve {

namespace {

Error system_error(int port, const char* what) {
    return Error(ExitCode::usage, "--port " + std::to_string(port) + ": " + what + " at 127.0.0.1: " +
                                      std::strerror(errno) + " (leave --port out for a free one)");
}

}  // namespace

Connections::Connections(int port, const Limits& limits) : limits_(limits) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    wake_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (listener_ < 0 || wake_ < 0) throw system_error(port, "no socket");
    const int yes = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener_, 1024) != 0)
        throw system_error(port, "cannot listen");
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
}

Connections::~Connections() {
    for (const auto& [id, peer] : peers_) ::close(peer.first);
    if (listener_ >= 0) ::close(listener_);
    if (wake_ >= 0) ::close(wake_);
}

void Connections::close_peer(std::uint64_t id) {
    const auto found = peers_.find(id);
    if (found == peers_.end()) return;
    ::close(found->second.first);
    peers_.erase(found);
}

/// The numbers rise, so the first one that still reads has waited longest.
void Connections::make_room() {
    if (peers_.size() < limits_.connections) return;
    for (const auto& [id, peer] : peers_)
        if (peer.second.phase == Peer::Phase::reading) return close_peer(id);
    close_peer(peers_.begin()->first);
}

void Connections::accept_all() {
    // A bounded number in a row, so that a flood of them does not keep answers from going out.
    for (int i = 0; i < 64; ++i) {
        const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (socket < 0) return;
        const int yes = 1;
        ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        make_room();
        Peer peer;
        peer.since = Clock::now();
        peers_.emplace(next_id_++, std::pair{socket, std::move(peer)});
    }
}

void Connections::answer(Peer& peer, const Response& response) {
    peer.phase = Peer::Phase::writing;
    peer.since = Clock::now();
    peer.bytes = response_bytes(response);
    peer.written = 0;
}

/// false: the connection is over.
bool Connections::read(std::uint64_t id, int socket, Peer& peer) {
    char buffer[16 * 1024];
    for (;;) {
        const ssize_t got = ::recv(socket, buffer, sizeof buffer, 0);
        if (got == 0) return false;
        if (got < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
        peer.bytes.append(buffer, std::size_t(got));
        const Framing framing = framing_of(peer.bytes);
        if (framing.refusal) {
            answer(peer, *framing.refusal);
            return write(socket, peer);
        }
        if (!framing.is_whole) continue;
        if (enqueue(id, peer)) return true;
        answer(peer, error_response(503, "too many requests wait; send it again"));
        return write(socket, peer);
    }
}

/// false: what waits is too much.
bool Connections::enqueue(std::uint64_t id, Peer& peer) {
    const std::lock_guard lock(mutex_);
    if (waiting_bytes_ + peer.bytes.size() > limits_.waiting_bytes) return false;
    waiting_bytes_ += peer.bytes.size();
    work_.push_back({id, std::move(peer.bytes)});
    peer.phase = Peer::Phase::working;
    peer.bytes = {};
    waiting_.notify_one();
    return true;
}

bool Connections::write(int socket, Peer& peer) {
    while (peer.written < peer.bytes.size()) {
        const ssize_t sent =
            ::send(socket, &peer.bytes[peer.written], peer.bytes.size() - peer.written, MSG_NOSIGNAL);
        if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
        peer.written += std::size_t(sent);
    }
    // What the peer still sends would turn the close into a reset, which takes the answer with it.
    ::shutdown(socket, SHUT_WR);
    char rest[16 * 1024];
    for (int i = 0; i < 256 && ::recv(socket, rest, sizeof rest, 0) > 0; ++i) {
    }
    return false;
}

void Connections::take_answers() {
    std::vector<std::pair<std::uint64_t, std::string>> answers;
    {
        const std::lock_guard lock(mutex_);
        std::uint64_t count = 0;
        [[maybe_unused]] const ssize_t got = ::read(wake_, &count, sizeof count);
        answers.swap(answers_);
    }
    for (auto& [id, bytes] : answers) {
        const auto found = peers_.find(id);
        if (found == peers_.end()) continue;
        Peer& peer = found->second.second;
        peer.phase = Peer::Phase::writing;
        peer.since = Clock::now();
        peer.bytes = std::move(bytes);
        if (!write(found->second.first, peer)) close_peer(id);
    }
}

void Connections::close_late() {
    const auto now = Clock::now();
    std::vector<std::uint64_t> late;
    for (auto& [id, entry] : peers_) {
        auto& [socket, peer] = entry;
        if (peer.phase == Peer::Phase::reading && now - peer.since > limits_.request) {
            answer(peer, error_response(408, "the request did not come within its time"));
            if (!write(socket, peer)) late.push_back(id);
        } else if (peer.phase == Peer::Phase::writing && now - peer.since > limits_.answer) {
            late.push_back(id);
        }
    }
    for (const std::uint64_t id : late) close_peer(id);
}

/// The newest stays, however long its answer is.
void Connections::close_beyond_memory() {
    std::size_t held = 0;
    for (const auto& [id, entry] : peers_) held += entry.second.bytes.capacity();
    while (held > limits_.held_bytes && peers_.size() > 1) {
        const auto oldest =
            std::ranges::find_if(peers_, [](const auto& peer) { return !peer.second.second.bytes.empty(); });
        if (oldest == peers_.end() || oldest->first == peers_.rbegin()->first) return;
        held -= oldest->second.second.bytes.capacity();
        close_peer(oldest->first);
    }
}

void Connections::poll_once() {
    std::vector<pollfd> waits{{listener_, POLLIN, 0}, {wake_, POLLIN, 0}};
    std::vector<std::uint64_t> ids;
    for (const auto& [id, entry] : peers_) {
        const auto phase = entry.second.phase;
        if (phase == Peer::Phase::working) continue;
        waits.push_back({entry.first, short(phase == Peer::Phase::reading ? POLLIN : POLLOUT), 0});
        ids.push_back(id);
    }
    constexpr int kStopIsSeenWithin_ms = 100;
    if (::poll(waits.data(), waits.size(), kStopIsSeenWithin_ms) < 0) return;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (waits[i + 2].revents == 0) continue;
        const auto found = peers_.find(ids[i]);
        if (found == peers_.end()) continue;  // closed for the memory of another
        auto& [socket, peer] = found->second;
        const bool lives =
            peer.phase == Peer::Phase::reading ? read(ids[i], socket, peer) : write(socket, peer);
        if (!lives) close_peer(ids[i]);
        close_beyond_memory();
    }
    take_answers();
    close_beyond_memory();
    close_late();
    if (waits[0].revents != 0) accept_all();
}

void Connections::work(const Handler& handler) {
    for (;;) {
        std::unique_lock lock(mutex_);
        waiting_.wait(lock, [&] { return ends_ || !work_.empty(); });
        if (ends_) return;
        const Work work = std::move(work_.front());
        work_.pop_front();
        waiting_bytes_ -= work.bytes.size();
        lock.unlock();
        const std::optional<Request> request = parse_request(work.bytes);
        Response response;
        try {
            response = request ? handler(*request) : error_response(400, "the request is not HTTP/1.1");
        } catch (const std::exception& error) {
            response = error_response(500, error.what());
        }
        std::string bytes = response_bytes(response);
        lock.lock();
        answers_.emplace_back(work.id, std::move(bytes));
        const std::uint64_t one = 1;
        [[maybe_unused]] const ssize_t sent = ::write(wake_, &one, sizeof one);
    }
}

void Connections::run(const Handler& handler, const std::atomic<bool>& stop) {
    std::vector<std::jthread> workers;
    for (int i = 0; i < limits_.workers; ++i) workers.emplace_back([&] { work(handler); });
    while (!stop) poll_once();
    const std::lock_guard lock(mutex_);
    ends_ = true;
    waiting_.notify_all();
}

}  // namespace aftershade::serve
