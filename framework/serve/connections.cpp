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

#include "framework/base/error.h"
#include "framework/base/option.h"

namespace aftershade::serve {

namespace {

// In one round, so that a flood of them keeps no answer from going out: a few milliseconds of work. Fewer are
// accepted, or a new one could be closed as the oldest before its turn.
constexpr int kMostAccepted = 64;
constexpr std::size_t kMostStrangers = 96;

Error system_error(int port, const char* what) {
    return Error(ErrorKind::usage, spelled(Option::port, std::to_string(port)) + ": " + what +
                                       " at 127.0.0.1: " + std::strerror(errno) +
                                       (errno == EADDRINUSE || errno == EACCES
                                            ? " (leave " + spelled(Option::port) + " out for a free one)"
                                            : ""));
}

}  // namespace

Connections::Connections(int port, const Limits& limits) : limits_(limits) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    wake_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (listener_ < 0 || wake_ < 0) throw system_error(port, "no socket");
    const int yes = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    ::setsockopt(listener_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);  // of those that it accepts, too
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
    for (const auto& [id, peer] : peers_) ::close(peer.socket);
    if (listener_ >= 0) ::close(listener_);
    if (wake_ >= 0) ::close(wake_);
}

void Connections::close_peer(std::uint64_t id) {
    const auto found = peers_.find(id);
    if (found == peers_.end()) return;
    ::close(found->second.socket);
    peers_.erase(found);
}

/// The oldest of those that have not shown that they may ask, else the oldest of all. The numbers rise.
template <typename Predicate>
bool Connections::close_oldest(const Predicate& is_one) {
    for (const bool may_ask : {false, true})
        for (const auto& [id, peer] : peers_)
            if (peer.may_ask == may_ask && peer.phase != Peer::Phase::working && is_one(id, peer)) {
                close_peer(id);
                return true;
            }
    return false;
}

bool Connections::make_room() {
    return peers_.size() < limits_.connections || close_oldest([](auto, const Peer&) { return true; });
}

/// Reads each at once: one that sent its request with the handshake waits for nobody, and one that was reset
/// meanwhile takes no place.
int Connections::accept_some(const Handlers& handlers) {
    for (int i = 0; i < kMostAccepted; ++i) {
        const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        // The process may have fewer files than was thought: this many, from now on.
        if (socket < 0 && (errno == EMFILE || errno == ENFILE)) {
            limits_.connections = std::max<std::size_t>(peers_.size(), 2) - 1;
            make_room();
        }
        if (socket < 0) return i;
        if (!make_room()) {
            ::close(socket);
            continue;
        }
        const std::uint64_t id = next_id_++;
        Peer& peer = peers_[id];
        peer.socket = socket;
        peer.since = Clock::now();
        if (!read(id, peer, handlers)) close_peer(id);
    }
    return kMostAccepted;
}

// What follows returns false where the connection is over.

bool Connections::answer(Peer& peer, const Response& response) {
    constexpr int kRefusals = 400;
    peer.phase = response.status >= kRefusals ? Peer::Phase::held : Peer::Phase::writing;
    peer.since = Clock::now();
    peer.may_ask = peer.is_kept = false;
    peer.incoming = {};
    peer.answer = response_bytes(response);
    return peer.phase == Peer::Phase::held || write(peer);
}

bool Connections::read(std::uint64_t id, Peer& peer, const Handlers& handlers) {
    char buffer[16 * 1024];
    const ssize_t got = ::recv(peer.socket, buffer, sizeof buffer, 0);
    if (got == 0) return false;
    if (got < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    if (!peer.incoming.has_begun()) peer.since = Clock::now();
    if (const auto refusal = peer.incoming.add({buffer, std::size_t(got)})) return answer(peer, *refusal);
    if (!peer.incoming.head()) return true;
    if (!peer.is_checked) {
        if (const auto response = handlers.at_once(*peer.incoming.head())) return answer(peer, *response);
        peer.may_ask = peer.is_checked = true;
    }
    if (!peer.incoming.is_whole() || enqueue(id, peer)) return true;
    return answer(peer, error_response(503, "too many requests wait; send it again"));
}

/// false: what waits is too much.
bool Connections::enqueue(std::uint64_t id, Peer& peer) {
    const std::lock_guard lock(mutex_);
    if (waiting_bytes_ + peer.incoming.held_bytes() > limits_.waiting_bytes) return false;
    peer.is_kept = peer.incoming.is_kept();
    work_.push_back({id, peer.is_kept, peer.incoming.take()});
    waiting_bytes_ += work_.back().request.body.size();
    peer.phase = Peer::Phase::working;
    waiting_.notify_one();
    return true;
}

bool Connections::write(Peer& peer) {
    while (peer.written < peer.answer.size()) {
        const ssize_t sent =
            ::send(peer.socket, &peer.answer[peer.written], peer.answer.size() - peer.written, MSG_NOSIGNAL);
        if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
        peer.written += std::size_t(sent);
    }
    peer.answer = {};
    peer.written = 0;
    peer.since = Clock::now();
    if (peer.is_kept) {
        peer.phase = Peer::Phase::reading;
        peer.incoming = {};
        peer.is_checked = false;  // browsers send requests of several pages over one connection
        return true;
    }
    // What the peer still sends would turn a close into a reset, which takes the answer with it.
    ::shutdown(peer.socket, SHUT_WR);
    peer.phase = Peer::Phase::lingering;
    return true;
}

bool Connections::linger(Peer& peer) {
    char rest[16 * 1024];
    const ssize_t got = ::recv(peer.socket, rest, sizeof rest, 0);
    return got > 0 || (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
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
        Peer& peer = found->second;
        peer.phase = Peer::Phase::writing;
        peer.since = Clock::now();
        peer.answer = std::move(bytes);
        if (!write(peer)) close_peer(id);
    }
}

void Connections::close_late() {
    using Phase = Peer::Phase;
    const auto now = Clock::now();
    std::vector<std::uint64_t> late;
    for (auto& [id, peer] : peers_) {
        const auto age = now - peer.since;
        const bool is_idle = peer.is_kept && !peer.incoming.has_begun();
        if (peer.phase == Phase::held && age > limits_.hold) {
            peer.phase = Phase::writing;
            if (!write(peer)) late.push_back(id);
        } else if (peer.phase == Phase::reading && !is_idle && age > limits_.request) {
            if (!answer(peer, error_response(408, "the request did not come within its time")))
                late.push_back(id);
        } else if ((peer.phase == Phase::writing && age > limits_.answer) ||
                   (peer.phase == Phase::reading && is_idle && age > limits_.kept) ||
                   (peer.phase == Phase::lingering && age > limits_.linger)) {
            late.push_back(id);
        }
    }
    for (const std::uint64_t id : late) close_peer(id);
}

/// The newest stays, however long its answer is.
void Connections::close_beyond_memory() {
    std::size_t held = 0;
    for (const auto& [id, peer] : peers_) held += peer.held_bytes();
    const auto is_one = [&](std::uint64_t id, const Peer& peer) {
        if (peer.held_bytes() == 0 || id == peers_.rbegin()->first) return false;
        held -= peer.held_bytes();
        return true;
    };
    while (held > limits_.held_bytes && close_oldest(is_one)) {
    }
}

/// Takes one step with a peer that is ready for it.
bool Connections::serve(std::uint64_t id, const Handlers& handlers) {
    Peer& peer = peers_.at(id);
    switch (peer.phase) {
        case Peer::Phase::reading: return read(id, peer, handlers);
        case Peer::Phase::writing: return write(peer);
        case Peer::Phase::lingering: return linger(peer);
        case Peer::Phase::held:
        case Peer::Phase::working: break;
    }
    return true;
}

/// Those that may ask come first, then some of the others in turn, and after a pause where they were many:
/// what always works gets its share of a busy machine, and what mostly sleeps is woken at once.
void Connections::poll_once(const Handlers& handlers) {
    constexpr int kStopIsSeenWithin_ms = 50, kPause_ms = 5;
    constexpr auto kPause = std::chrono::milliseconds(kPause_ms);
    const auto now = Clock::now();
    const bool accepts = now >= accepts_from_, takes_pieces = now >= takes_pieces_from_;
    bool is_pause = !accepts;
    std::vector<pollfd> waits{{listener_, short(accepts ? POLLIN : 0), 0}, {wake_, POLLIN, 0}};
    std::vector<std::uint64_t> ids;
    for (const auto& [id, peer] : peers_) {
        if (peer.phase == Peer::Phase::working || peer.phase == Peer::Phase::held) continue;
        const bool is_due = peer.may_ask || (peer.is_new() ? accepts : takes_pieces);
        if (!is_due) is_pause = true;
        if (!is_due) continue;
        waits.push_back({peer.socket, short(peer.phase == Peer::Phase::writing ? POLLOUT : POLLIN), 0});
        ids.push_back(id);
    }
    if (::poll(waits.data(), waits.size(), is_pause ? kPause_ms : kStopIsSeenWithin_ms) < 0) return;
    take_answers();
    std::vector<std::uint64_t> strangers;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (waits[i + 2].revents == 0) continue;
        if (!peers_.at(ids[i]).may_ask) strangers.push_back(ids[i]);
        else if (!serve(ids[i], handlers)) close_peer(ids[i]);
    }
    std::ranges::rotate(strangers, std::ranges::lower_bound(strangers, next_stranger_));
    strangers.resize(std::min(strangers.size(), kMostStrangers));
    for (const std::uint64_t id : strangers) {
        next_stranger_ = id + 1;
        if (!peers_.at(id).is_new()) takes_pieces_from_ = now + 2 * kPause;
        if (!serve(id, handlers)) close_peer(id);
    }
    close_beyond_memory();
    close_late();
    if (waits[0].revents != 0 && accept_some(handlers) == kMostAccepted) accepts_from_ = now + kPause;
}

void Connections::reply(std::uint64_t id, bool is_kept, const Response& response) {
    std::string bytes = response_bytes(response, is_kept);
    const std::lock_guard lock(mutex_);
    answers_.emplace_back(id, std::move(bytes));
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t sent = ::write(wake_, &one, sizeof one);
}

void Connections::work(const Handlers& handlers) {
    for (;;) {
        std::unique_lock lock(mutex_);
        waiting_.wait(lock, [&] { return ends_ || !work_.empty(); });
        if (ends_) return;
        const Work work = std::move(work_.front());
        work_.pop_front();
        waiting_bytes_ -= work.request.body.size();
        lock.unlock();
        const Reply reply_to = [this, id = work.id, is_kept = work.is_kept](const Response& response) {
            reply(id, is_kept, response);
        };
        try {
            handlers.work(work.request, reply_to);
        } catch (const std::exception& error) {
            reply_to(fault_response(error));
        }
    }
}

void Connections::run(const Handlers& handlers, const std::atomic<bool>& stop) {
    std::vector<std::jthread> workers;
    for (int i = 0; i < limits_.workers; ++i) workers.emplace_back([&] { work(handlers); });
    while (!stop) poll_once(handlers);
    const std::lock_guard lock(mutex_);
    ends_ = true;
    waiting_.notify_all();
}

}  // namespace aftershade::serve
