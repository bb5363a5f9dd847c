#include "framework/base/spare_memory.h"

#include <gtest/gtest.h>

#include <cstring>

namespace aftershade {
namespace {

constexpr std::size_t kBytes = 4 << 20;

TEST(SpareMemory, GoesToTheNextThatTakesAsMuch) {
    drop_spare_memory();
    const SpareMemory first = take_spare_memory(kBytes, 2);
    ASSERT_EQ(first.bytes, kBytes);
    std::memset(first.memory, 77, kBytes);
    give_spare_memory(first);
    const SpareMemory other = take_spare_memory(kBytes / 2, 1);
    EXPECT_NE(other.memory, first.memory);
    const SpareMemory second = take_spare_memory(kBytes, 1);
    EXPECT_EQ(second.memory, first.memory);
    EXPECT_EQ(static_cast<const char*>(second.memory)[kBytes - 1], 77);
    const SpareMemory third = take_spare_memory(kBytes, 1);
    EXPECT_NE(third.memory, second.memory);
    for (const SpareMemory& spare : {other, second, third}) give_spare_memory(spare);
    drop_spare_memory();
}

TEST(SpareMemory, IsOneArrayAtMost) {
    drop_spare_memory();
    const SpareMemory a = take_spare_memory(kBytes, 1), b = take_spare_memory(2 * kBytes, 1);
    give_spare_memory(a);
    give_spare_memory(b);
    EXPECT_EQ(take_spare_memory(2 * kBytes, 1).memory, b.memory);
    give_spare_memory(b);
    drop_spare_memory();
}

TEST(SpareMemory, OfNothingIsNothing) {
    EXPECT_EQ(take_spare_memory(0, 1).memory, nullptr);
    give_spare_memory({});
}

}  // namespace
}  // namespace aftershade
