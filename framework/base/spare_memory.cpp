#include "framework/base/spare_memory.h"

#include <cstdlib>
#include <mutex>
#include <new>
#include <utility>

#include "framework/base/memory_pages.h"

namespace aftershade {

namespace {

/// Of smaller ones the allocator keeps the pages itself.
constexpr std::size_t kLeastKept_bytes = std::size_t{1} << 20;

struct Kept {
    std::mutex mutex;
    SpareMemory spare{};
};

/// Never ends: images may outlive what lives in functions.
Kept& kept() {
    static Kept& kept = *new Kept;
    return kept;
}

/// What was kept, in whose place `spare` is kept now.
SpareMemory exchanged(SpareMemory spare) noexcept {
    const std::scoped_lock lock(kept().mutex);
    return std::exchange(kept().spare, spare);
}

SpareMemory taken_from_kept(std::size_t bytes) noexcept {
    const std::scoped_lock lock(kept().mutex);
    return kept().spare.bytes == bytes ? std::exchange(kept().spare, {}) : SpareMemory{};
}

}  // namespace

SpareMemory take_spare_memory(std::size_t bytes, int threads) {
    if (bytes == 0) return {};
    if (const SpareMemory spare = taken_from_kept(bytes); spare.memory) return spare;
    void* const memory = std::malloc(bytes);
    if (!memory) throw std::bad_alloc();
    make_pages({static_cast<std::byte*>(memory), bytes}, threads);
    return {memory, bytes};
}

void give_spare_memory(SpareMemory spare) noexcept {
    if (spare.bytes >= kLeastKept_bytes) spare = exchanged(spare);
    std::free(spare.memory);
}

void drop_spare_memory() noexcept {
    std::free(exchanged({}).memory);
}

}  // namespace aftershade
