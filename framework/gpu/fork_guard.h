// A forked child has none of its parent's threads. Mesa keeps one screen for the process, whose rasterizer
// threads every context waits for: in the child even a new context would wait for ever.
#pragma once

#include <utility>

namespace aftershade::gpu {

/// From now on a fork makes is_forked_from_gl() true in the child; call before the first work of a context.
/// [any thread]
void watch_for_forks() noexcept;

/// Whether this process was forked, directly or not, from one that had made a context. [any thread]
bool is_forked_from_gl() noexcept;

/// Throws Error(ErrorKind::usage) where is_forked_from_gl().
void require_not_forked();

/// Never destroys `owner`'s object: in a forked child its destructor would wait for threads that are not
/// there.
template <typename Owner>
void leave_to_exit(Owner&& owner) {
    static_cast<void>(new Owner(std::forward<Owner>(owner)));
}

}  // namespace aftershade::gpu
