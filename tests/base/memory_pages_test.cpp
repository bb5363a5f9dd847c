#include "framework/base/memory_pages.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <span>

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace aftershade {
namespace {

long page_faults() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

bool system_makes_pages() {
    const auto page = std::size_t(sysconf(_SC_PAGESIZE));
    void* const memory = mmap(nullptr, page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    constexpr int kPopulateWrite = 23;
    const bool works = madvise(memory, page, kPopulateWrite) == 0;
    munmap(memory, page);
    return works;
}

TEST(MakePages, LeavesNoPageToBeMadeByWhoWrites) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer makes pages of its own for those that are written";
#endif
    if (!system_makes_pages()) GTEST_SKIP() << "Linux before 5.14 makes no pages ahead";
    constexpr std::size_t kBytes = 32 << 20;
    const std::unique_ptr<std::byte, decltype(&std::free)> memory(
        static_cast<std::byte*>(std::calloc(kBytes, 1)), &std::free);
    const std::span<std::byte> bytes(memory.get() + 3, kBytes - 3);
    const auto page = std::size_t(sysconf(_SC_PAGESIZE));
    make_pages(bytes, 2);
    const long before = page_faults();
    for (std::size_t i = 0; i < bytes.size(); i += page) bytes[i] = std::byte(1);
    // The first and the last, of which a part belongs to somebody else, and what the test itself touches.
    EXPECT_LT(page_faults() - before, 64) << "of " << kBytes / page << " pages";
}

TEST(MakePages, KeepsWhatIsThere) {
    constexpr std::size_t kBytes = 8 << 20;
    const std::unique_ptr<std::byte, decltype(&std::free)> memory(
        static_cast<std::byte*>(std::calloc(kBytes, 1)), &std::free);
    const std::span<std::byte> bytes(memory.get(), kBytes);
    for (std::size_t i = 0; i < kBytes; i += 12345) bytes[i] = std::byte(i % 251 + 1);
    make_pages(bytes, 2);
    make_pages(bytes.first(10), 2);
    make_pages({}, 2);
    for (std::size_t i = 0; i < kBytes; i += 12345) ASSERT_EQ(bytes[i], std::byte(i % 251 + 1)) << i;
    EXPECT_EQ(bytes[1], std::byte(0));
}

}  // namespace
}  // namespace aftershade
