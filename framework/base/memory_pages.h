// Pages of memory that the system has not made yet.
#pragma once

#include <cstddef>
#include <span>

namespace aftershade {

/// Has the system make all pages of fresh memory now, on `threads` threads. A single one that fills the
/// memory takes three times as long over its pages as over its values. The content stays; where the system
/// cannot do it (before Linux 5.14), pages are made when they are touched, as ever.
void make_pages(std::span<std::byte> memory, int threads);

}  // namespace aftershade
