#include "framework/base/memory_pages.h"

#include <algorithm>
#include <cstdint>
#include <memory>

#include <sys/mman.h>
#include <unistd.h>

#include "framework/base/parallel.h"

namespace aftershade {

void make_pages(std::span<std::byte> memory, int threads) {
#if defined(MADV_POPULATE_WRITE)
    const auto page = std::size_t(sysconf(_SC_PAGESIZE));
    void* begin = memory.data();
    std::size_t bytes = memory.size();
    if (!std::align(page, page, begin, bytes)) return;
    std::byte* const first = static_cast<std::byte*>(begin);
    for_each_part(parts_for_threads(bytes / page * page, page, threads), [&](const Part& part) {
        return madvise(first + part.begin, part.end - part.begin, MADV_POPULATE_WRITE);
    });
#else
    static_cast<void>(memory);
    static_cast<void>(threads);
#endif
}

}  // namespace aftershade
