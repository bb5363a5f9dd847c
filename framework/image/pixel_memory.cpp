#include "framework/image/pixel_memory.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <new>

#include "framework/base/memory_limit.h"

namespace aftershade {
namespace {

/// The C library keeps what is smaller.
constexpr std::size_t kLeastBytes = std::size_t{1} << 20;
/// 8 pictures of 3840x2160 with four channels.
constexpr std::size_t kMostKeptBytes = std::size_t{1} << 30;

struct Block {
    void* memory;
    std::size_t bytes;
};

class Kept {
public:
    /// nullptr where no block has the size: then the oldest ones make room for as many bytes.
    void* take(std::size_t bytes) noexcept {
        const std::lock_guard lock(mutex_);
        const auto found = std::ranges::find(blocks_, bytes, &Block::bytes);
        if (found == blocks_.end()) {
            shrink_to(bytes_ > bytes ? bytes_ - bytes : 0);
            return nullptr;
        }
        void* const memory = found->memory;
        bytes_ -= bytes;
        blocks_.erase(found);
        return memory;
    }
    void give(Block block) noexcept {
        const std::lock_guard lock(mutex_);
        try {
            blocks_.push_back(block);
        } catch (const std::bad_alloc&) {
            std::free(block.memory);
            return;
        }
        bytes_ += block.bytes;
        shrink_to(kMostKeptBytes);
    }
    void drop() noexcept {
        const std::lock_guard lock(mutex_);
        shrink_to(0);
    }

private:
    void shrink_to(std::size_t most_bytes) noexcept {
        while (bytes_ > most_bytes) {
            std::free(blocks_.front().memory);
            bytes_ -= blocks_.front().bytes;
            blocks_.pop_front();
        }
    }

    std::mutex mutex_;
    std::deque<Block> blocks_;  // the oldest first
    std::size_t bytes_ = 0;
};

/// Never destroyed: images of static duration may end after it would.
Kept& kept() {
    static Kept* const all = new Kept;
    return *all;
}

}  // namespace

void* take_pixel_memory(std::size_t bytes, FirstValues first) {
    if (bytes >= kLeastBytes) {
        if (void* const memory = kept().take(bytes)) {
            if (first == FirstValues::zero) std::memset(memory, 0, bytes);
            return memory;
        }
    }
    // The system's pages are zero without being written, so calloc() costs no more than malloc().
    void* memory = std::calloc(bytes, 1);
    if (!memory && bytes > 0) {
        drop_kept_pixel_memory();
        memory = std::calloc(bytes, 1);
    }
    if (!memory && bytes > 0) throw std::bad_alloc();
    return memory;
}

void give_pixel_memory(void* memory, std::size_t bytes) noexcept {
    // Below a limit, what is kept could be what another allocation lacks.
    static const bool is_limited = address_space_left().has_value();
    if (memory && bytes >= kLeastBytes && !is_limited) kept().give({memory, bytes});
    else std::free(memory);
}

void drop_kept_pixel_memory() noexcept {
    kept().drop();
}

}  // namespace aftershade
