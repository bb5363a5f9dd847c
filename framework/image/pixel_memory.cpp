#include "framework/image/pixel_memory.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <new>

#include "framework/base/memory_limit.h"

namespace aftershade {
namespace {

/// The C library keeps what is smaller.
constexpr std::size_t kLeastBytes = std::size_t{1} << 20;
/// 8 pictures of 3840x2160 with four channels.
constexpr std::size_t kMostKeptBytes = std::size_t{1} << 30;

/// Below a limit, what is kept could be what another allocation lacks. The address sanitizer would not see a
/// use after the end.
bool keeps() {
#ifdef __SANITIZE_ADDRESS__
    return false;
#else
    static const bool has_no_limit = !address_space_left();
    return has_no_limit;
#endif
}

struct Block {
    void* memory;
    std::size_t bytes;
};

class Kept {
public:
    /// nullptr where no block has the size: then the oldest ones make room for as many bytes.
    void* take(std::size_t bytes) noexcept {
        const std::lock_guard lock(mutex_);
        ++in_use_;
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
        --in_use_;
        try {
            blocks_.push_back(block);
            bytes_ += block.bytes;
        } catch (const std::bad_alloc&) {
            std::free(block.memory);
        }
        shrink_to(in_use_ > 0 ? kMostKeptBytes : 0);
    }
    /// Takes back the count of take() if the system has no memory either.
    void forget() noexcept {
        const std::lock_guard lock(mutex_);
        --in_use_;
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
    std::size_t bytes_ = 0;     // of them
    std::size_t in_use_ = 0;    // blocks that were taken and not given back
};

/// Never destroyed: images of static duration may end after it would.
Kept& kept() {
    static Kept* const all = new Kept;
    return *all;
}

}  // namespace

void* take_pixel_memory(std::size_t count, std::size_t size, FirstValues first) {
    if (count > std::numeric_limits<std::size_t>::max() / size) throw std::bad_alloc();
    const std::size_t bytes = count * size;
    const bool may_be_kept = bytes >= kLeastBytes && keeps();
    if (may_be_kept) {
        if (void* const memory = kept().take(bytes)) {
            if (first == FirstValues::zero) std::memset(memory, 0, bytes);
            return memory;
        }
    }
    // Fresh pages are zero without being written, but calloc() writes what the C library had kept.
    const auto allocated = [&] {
        return first == FirstValues::zero ? std::calloc(bytes, 1) : std::malloc(bytes);
    };
    void* memory = allocated();
    if (!memory && may_be_kept) {
        kept().drop();
        memory = allocated();
        if (!memory) kept().forget();
    }
    if (!memory && bytes > 0) throw std::bad_alloc();
    return memory;
}

void give_pixel_memory(void* memory, std::size_t bytes) noexcept {
    if (memory && bytes >= kLeastBytes && keeps()) kept().give({memory, bytes});
    else std::free(memory);
}

}  // namespace aftershade
