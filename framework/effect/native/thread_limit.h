// How many threads a process of untrusted code may have, counted by the process that started it.
#pragma once

#include <sys/types.h>

#include <thread>

#include "framework/base/child_process.h"

namespace aftershade {

/// 512, or four for each processor where that is more.
unsigned most_plugin_threads();

/// The child's side: sends the descriptor of notice_threads() through a stream of sockets; without one (-1) a
/// message alone.
bool send_thread_notices(int stream, int notices);
/// The other side. False where nothing has come yet, or the stream has failed (errno) or ended (0).
bool receive_thread_notices(int stream, Descriptor& notices);

/// Answers for each new thread of `process` until destroyed: the thread starts, or fails with EAGAIN where
/// the process has `most`. Threads that are started at once from many threads are counted late, so that there
/// may be twice as many.
class ThreadLimit {
public:
    ThreadLimit(Descriptor notices, pid_t process, unsigned most);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    Pipe stop_;
    std::thread thread_;
};

}  // namespace aftershade
