// The memory of pictures, which the next picture of the same size takes over.
#pragma once

#include <cstddef>

namespace aftershade {

enum class FirstValues { zero, unwritten };

/// Memory of `count` numbers of `size` bytes. Pages that are fresh from the system are made one by one when
/// they are first touched, which takes several times as long as to write the pixels. So what one picture
/// gives back is kept for the next one, as long as any picture is in use. What is in use and what is kept
/// together never exceed what was once in use. Nothing is kept where the address space has a limit. Throws
/// std::bad_alloc. [thread-safe]
void* take_pixel_memory(std::size_t count, std::size_t size, FirstValues first);
/// Ends the use of what take_pixel_memory() gave for `bytes`; nullptr is ignored. [thread-safe]
void give_pixel_memory(void* memory, std::size_t bytes) noexcept;

}  // namespace aftershade
