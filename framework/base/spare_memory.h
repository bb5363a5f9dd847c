// Memory of large arrays that come again with each frame.
//
// The system makes the pages of new memory one by one, as zeros, and takes them back with the memory: for a
// picture at 1920x1080 that is a quarter of the time of reading it back.
#pragma once

#include <cstddef>

namespace aftershade {

struct SpareMemory {
    void* memory = nullptr;
    std::size_t bytes = 0;
};

/// What was given last, if it has as many bytes, else new memory, of which `threads` make the pages; it holds
/// anything. Throws std::bad_alloc. [any thread]
SpareMemory take_spare_memory(std::size_t bytes, int threads);
/// Keeps it for the next one to take; what was kept before goes back to the system. [any thread]
void give_spare_memory(SpareMemory spare) noexcept;
/// Gives what is kept back to the system. [any thread]
void drop_spare_memory() noexcept;

}  // namespace aftershade
