// A command to run as a worker, and what holds it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "framework/base/child_process.h"

namespace aftershade {

struct WorkerLimits : ChildLimits {
    std::optional<std::chrono::milliseconds> wall_time;  ///< from the start; then the child is killed
    /// Memory that the child really uses (RSS), looked at ten times a second; then it is killed. Unlike
    /// `memory_bytes` it leaves alone what GPU drivers reserve.
    std::optional<std::uint64_t> resident_bytes;
};

struct WorkerCommand {
    /// The first is the program's path. PATH is not searched, and no shell looks at any.
    std::vector<std::string> arguments;
    std::map<std::string, std::string> environment;  ///< added to this process's, or in its place
    std::set<std::string> without;                   ///< variables of this process that it does not get
    WorkerLimits limits;
    /// It writes to this process's standard output and error, and the listener hears none of it.
    bool shares_streams = false;
    /// A descriptor of this process, from make_pipe or make_socket_pair, that it has as its standard input,
    /// which is empty otherwise (-1).
    int input = -1;
    /// How long a worker may take to end after SIGTERM (after an interrupt) before it is killed.
    std::chrono::milliseconds grace{2000};
    /// Once raised: the worker hangs, and half a second is all that it is given. May be null.
    const std::atomic<bool>* hangs = nullptr;
};

}  // namespace aftershade
