// Hosts that any thread of Python may call.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <mutex>
#include <utility>

#include <unistd.h>

#include "aftershade/host.h"

namespace aftershade::python {

/// A Host that is given to the thread that calls it: calls on one Host wait for each other, and other threads
/// of Python run in the meantime.
struct SharedHost {
    explicit SharedHost(host::HostOptions options) : host(std::move(options)) { host.detach(); }

    /// What `work` returns, which must hold no Python object. Without the GIL, in this thread alone.
    template <typename Work>
    auto call(Work work) {
        renew_after_fork();
        const nanobind::gil_scoped_release released;
        const std::lock_guard lock(*mutex);
        const Detach detach{host};
        return work();
    }

    host::Host host;

private:
    std::unique_ptr<std::mutex> mutex = std::make_unique<std::mutex>();
    pid_t process = getpid();

    /// Another thread of the parent may have held the lock at the fork; in the child no thread gives it back.
    void renew_after_fork() {
        if (process == getpid()) return;
        process = getpid();
        static_cast<void>(mutex.release());
        mutex = std::make_unique<std::mutex>();
    }

    struct Detach {
        host::Host& host;
        ~Detach() {
            if (!host.is_closed()) host.detach();
        }
    };
};

using HostPointer = std::shared_ptr<SharedHost>;

/// What is made by a host keeps it: sequences obey its limits, looks and sessions lie on its GPU.
struct SequenceOfHost {
    HostPointer host;
    host::Sequence sequence;
};

}  // namespace aftershade::python
