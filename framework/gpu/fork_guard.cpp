#include "framework/gpu/fork_guard.h"

#include <atomic>

#include <pthread.h>

#include "framework/base/error.h"

namespace aftershade::gpu {
namespace {

std::atomic<bool> has_made_context = false;
std::atomic<bool> is_forked = false;

}  // namespace

void watch_for_forks() noexcept {
    if (has_made_context.exchange(true)) return;
    static_cast<void>(pthread_atfork(nullptr, nullptr, [] { is_forked = true; }));
}

bool is_forked_from_gl() noexcept {
    return is_forked;
}

void require_not_forked() {
    if (is_forked)
        throw Error(
            ErrorKind::usage,
            "this process was forked from one that had an OpenGL context, and OpenGL's threads are not "
            "in a forked process; start a new program instead (in Python: "
            "multiprocessing.get_context(\"spawn\")), or fork before the first render");
}

}  // namespace aftershade::gpu
