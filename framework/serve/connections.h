// Connections of 127.0.0.1: whole requests in, answers out, on as many threads as there is work for.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "framework/serve/http_message.h"

namespace aftershade::serve {

/// cpp-httplib, the library of this size in Debian, gives each connection a thread until its request is
/// there, so that as many slow peers as it has threads stop it. One thread reads and writes all sockets
/// without ever waiting for one of them, takes 16 KiB of each in turn, and looks at each byte once, so that a
/// peer that is slow, or that has a thousand connections, delays no other. Only a request that is let
/// through, and that is there as a whole, goes to one of a few workers.
class Connections {
public:
    struct Limits {
        /// Beyond these, the server closes the oldest connection that has not shown a token. A process may
        /// have 1024 files.
        std::size_t connections = 700;
        std::chrono::milliseconds request{10'000};  ///< from the first byte to the last
        std::chrono::milliseconds answer{30'000};   ///< for the peer to take it
        std::chrono::milliseconds kept{60'000};     ///< without a further request
        /// Before a refusal is sent, so that few peers cannot make many of them; it costs nothing meanwhile.
        std::chrono::milliseconds hold{200};
        std::chrono::milliseconds linger{1'000};  ///< for what the peer still sends after its answer
        int workers = 8;
        /// Bytes of incomplete requests and of unread answers; above that, the oldest are closed.
        std::size_t held_bytes = std::size_t(24) << 20;
        std::size_t waiting_bytes = std::size_t(8) << 20;  ///< of whole requests; beyond, they are refused
    };
    using Reply = std::function<void(Response)>;
    struct Handlers {
        /// Answers a request before its body is read, on the thread of the sockets, so that it may not take
        /// long. nullopt lets the request through to `work`.
        std::function<std::optional<Response>(const Request& head)> at_once;
        /// Called on several threads. Calls `reply` once, on any thread, during the call or later, while
        /// these Connections live.
        std::function<void(const Request& request, const Reply& reply)> work;
    };

    /// Listens at `port` of 127.0.0.1; 0: at a free one. Throws Error(ErrorKind::usage) where that is taken.
    Connections(int port, const Limits& limits);
    ~Connections();
    Connections(const Connections&) = delete;
    Connections& operator=(const Connections&) = delete;

    int port() const { return port_; }
    /// Until `stop`, and until the handlers that still work then have ended.
    void run(const Handlers& handlers, const std::atomic<bool>& stop);

private:
    using Clock = std::chrono::steady_clock;
    struct Peer {
        enum class Phase { reading, working, held, writing, lingering };
        int socket = -1;
        Phase phase = Phase::reading;
        bool may_ask = false;     // its last head was let through
        bool is_checked = false;  // the head of the present request was let through
        bool is_kept = false;     // once its answer is written it may ask again
        Clock::time_point since{};
        Incoming incoming;
        std::string answer;
        std::size_t written = 0;  // of the answer

        bool is_new() const { return phase == Phase::reading && !incoming.has_begun(); }
        std::size_t held_bytes() const {
            return incoming.held_bytes() + (answer.empty() ? 0 : answer.capacity());
        }
    };
    struct Work {
        std::uint64_t id = 0;
        bool is_kept = false;
        Request request;
    };

    int accept_some(const Handlers& handlers);
    bool make_room();
    bool read(std::uint64_t id, Peer& peer, const Handlers& handlers);
    bool write(Peer& peer);
    bool linger(Peer& peer);
    bool answer(Peer& peer, const Response& response);
    bool serve(std::uint64_t id, const Handlers& handlers);
    void take_answers();
    void close_late();
    void close_beyond_memory();
    template <typename Predicate>
    bool close_oldest(const Predicate& is_one);
    bool enqueue(std::uint64_t id, Peer& peer);
    void reply(std::uint64_t id, bool is_kept, const Response& response);
    void work(const Handlers& handlers);
    void poll_once(const Handlers& handlers);
    void close_peer(std::uint64_t id);

    Limits limits_;
    int listener_ = -1;
    int wake_ = -1;  // an eventfd: answers wait
    int port_ = 0;
    std::uint64_t next_id_ = 0;
    std::uint64_t next_stranger_ = 0;                         // whose turn it is
    Clock::time_point accepts_from_{}, takes_pieces_from_{};  // of those that may not ask
    std::map<std::uint64_t, Peer> peers_;  // by number, oldest first: sockets are used again

    std::mutex mutex_;  // of what follows
    std::condition_variable waiting_;
    std::deque<Work> work_;
    std::size_t waiting_bytes_ = 0;  // of work_
    std::vector<std::pair<std::uint64_t, std::string>> answers_;
    bool ends_ = false;
};

}  // namespace aftershade::serve
