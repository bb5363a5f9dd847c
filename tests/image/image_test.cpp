#include "framework/image/image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include <unistd.h>

#include "framework/base/memory_limit.h"

namespace aftershade {
namespace {

TEST(AnImage, IsZeroAlsoInMemoryThatHeldAnother) {
    // Of a size that the allocator keeps for the next one, and of one that it gives back to the system.
    for (const int side : {8, 700})
        for (int turn = 0; turn < 3; ++turn) {
            Image floats(side, side, 3), uints(side, side, 1, ComponentType::uint32);
            EXPECT_TRUE(std::ranges::all_of(floats.floats(), [](float value) { return value == 0; }));
            EXPECT_TRUE(std::ranges::all_of(uints.uints(), [](std::uint32_t value) { return value == 0; }));
            std::ranges::fill(floats.floats(), 1.5f);
            std::ranges::fill(uints.uints(), 7u);
        }
}

/// Nothing is kept then.
bool has_limit() {
#ifdef __SANITIZE_ADDRESS__
    return true;
#else
    return address_space_left().has_value();
#endif
}

TEST(AnImage, TakesOverTheMemoryOfOneOfItsSize) {
    if (has_limit()) GTEST_SKIP() << "the address space has a limit, or the sanitizer watches it";
    const auto memory_of = [](const Image& image) { return image.floats().data(); };
    const Image other(600, 600, 3);
    const float* const first = memory_of(Image(700, 700, 3));
    EXPECT_EQ(memory_of(Image(700, 700, 3, ComponentType::float32, FirstValues::unwritten)), first);
    EXPECT_EQ(memory_of(Image(700, 700, 3)), first);
}

/// Pages of a picture of 64 MiB count only once something is written to them.
TEST(Images, HoldNoMoreMemoryThanWasOnceInUseAndNoneAfterTheLast) {
    if (has_limit()) GTEST_SKIP() << "the address space has a limit, or the sanitizer watches it";
    constexpr std::uint64_t kMiB = 1 << 20;
    const std::uint64_t before = resident_bytes(getpid());
    const auto write = [](int side) {
        Image image(side, side, 4);
        std::ranges::fill(image.floats(), 1.5f);
    };
    {
        const Image other(600, 600, 3);
        write(2048);  // 64 MiB
        EXPECT_GT(resident_bytes(getpid()), before + 60 * kMiB) << "what was given back is not kept";
        for (const int side : {2047, 2046, 2045}) write(side);
        EXPECT_LT(resident_bytes(getpid()), before + 80 * kMiB);
    }
    EXPECT_LT(resident_bytes(getpid()), before + 20 * kMiB);
}

TEST(AnImage, IsCopiedWithItsValuesAndMovedWithItsMemory) {
    Image image(3, 2, 2);
    for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = float(i) + 0.25f;
    const Image copy = image;
    const float* const memory = image.floats().data();
    image.at(0, 0, 0) = -1;
    EXPECT_EQ(copy.at(0, 0, 0), 0.25f);
    EXPECT_EQ(copy.at(2, 1, 1), 11.25f);
    Image moved = std::move(image);
    EXPECT_EQ(moved.floats().data(), memory);
    Image assigned(1, 1, 1, ComponentType::uint32);
    assigned = moved;
    EXPECT_NE(assigned.floats().data(), memory);
    EXPECT_TRUE(std::ranges::equal(assigned.floats(), moved.floats()));
    assigned = std::move(moved);
    EXPECT_EQ(assigned.floats().data(), memory);
}

TEST(AnImage, MayHoldNothing) {
    const Image none, copy = none, flat(0, 5, 3);
    EXPECT_TRUE(none.empty() && copy.empty() && flat.empty());
    EXPECT_TRUE(copy.floats().empty() && Image(flat).floats().empty());
}

TEST(AnImage, TakesTheValuesOfAnotherOfAnotherSizeAndTypeAndOfItself) {
    Image image(4, 4, 1), ids(2, 1, 1, ComponentType::uint32);
    ids.uint_at(1, 0, 0) = 9;
    image = ids;
    ids.uint_at(1, 0, 0) = 4;
    EXPECT_EQ(image.type(), ComponentType::uint32);
    EXPECT_EQ(image.uint_at(1, 0, 0), 9u);
    EXPECT_EQ(image.uints().size(), 2u);
    const Image& same = image;
    image = same;
    EXPECT_EQ(image.uint_at(1, 0, 0), 9u);
    image = Image();
    EXPECT_TRUE(image.empty());
    const Image none = image;
    EXPECT_TRUE(none.floats().empty());
}

}  // namespace
}  // namespace aftershade
