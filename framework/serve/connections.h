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
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "framework/serve/http_message.h"

namespace aftershade::serve {

/// cpp-httplib, the library of this size in Debian, gives each connection a thread until its request is
/// there, so that as many slow peers as it has threads stop it. One thread reads and writes all sockets
/// without ever waiting for one of them, so that a peer that is slow, or that has a thousand connections,
/// delays no other. Only a request that is there as a whole goes to one of a few workers.
class Connections {
public:
    struct Limits {
        std::size_t connections =
            256;  ///< of more, the one that has waited longest for its request is closed
        std::chrono::milliseconds request{10'000};  ///< from the first byte to the last
        std::chrono::milliseconds answer{30'000};   ///< for the peer to take it
        int workers = 8;
        /// Of requests that are not whole, and of answers that are not taken; beyond, the oldest are closed.
        std::size_t held_bytes = std::size_t(24) << 20;
        std::size_t waiting_bytes = std::size_t(8) << 20;  ///< of whole requests; beyond, they are refused
    };
    using Handler = std::function<Response(const Request&)>;

    /// Listens at `port` of 127.0.0.1; 0: at a free one. Throws Error(ExitCode::usage) where that is taken.
    Connections(int port, const Limits& limits);
    ~Connections();
    Connections(const Connections&) = delete;
    Connections& operator=(const Connections&) = delete;

    int port() const { return port_; }
    /// Until `stop`, and until the handlers that still work then have ended; `handler` is called on several
    /// threads.
    void run(const Handler& handler, const std::atomic<bool>& stop);

private:
    using Clock = std::chrono::steady_clock;
    struct Peer {
        enum class Phase { reading, working, writing };
        Phase phase = Phase::reading;
        Clock::time_point since{};
        std::string bytes;        // that came, or that are to go
        std::size_t written = 0;  // of them
    };
    struct Work {
        std::uint64_t id = 0;
        std::string bytes;
    };

    void accept_all();
    void make_room();
    bool read(std::uint64_t id, int socket, Peer& peer);
    bool write(int socket, Peer& peer);
    void answer(Peer& peer, const Response& response);
    void take_answers();
    void close_late();
    void close_beyond_memory();
    bool enqueue(std::uint64_t id, Peer& peer);
    void work(const Handler& handler);
    void poll_once();
    void close_peer(std::uint64_t id);

    Limits limits_;
    int listener_ = -1;
    int wake_ = -1;  // an eventfd: answers wait
    int port_ = 0;
    std::uint64_t next_id_ = 0;
    std::map<std::uint64_t, std::pair<int, Peer>> peers_;  // by number: sockets are used again

    std::mutex mutex_;  // of what follows
    std::condition_variable waiting_;
    std::deque<Work> work_;
    std::size_t waiting_bytes_ = 0;  // of work_
    std::vector<std::pair<std::uint64_t, std::string>> answers_;
    bool ends_ = false;
};

}  // namespace aftershade::serve
