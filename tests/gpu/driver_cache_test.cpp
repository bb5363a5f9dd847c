// When Mesa's cache holds what was compiled.
#include "framework/gpu/driver_cache.h"

#include <chrono>

#include <gtest/gtest.h>

namespace aftershade::gpu {
namespace {

TEST(DriverCache, IsWrittenByThreadsThatRunOrWaitForTheDisk) {
    EXPECT_TRUE(is_writing_driver_cache("71 (aftersh:disk$0) R 1 71 1"));
    EXPECT_TRUE(is_writing_driver_cache("71 (aftersh:disk$3) D 1 71 1"));
    EXPECT_TRUE(is_writing_driver_cache("71 (a) b:disk$0) R 1 71 1")) << "a name with a bracket";
    EXPECT_FALSE(is_writing_driver_cache("71 (aftersh:disk$0) S 1 71 1")) << "it waits for work";
    EXPECT_FALSE(is_writing_driver_cache("71 (aftershade) R 1 71 1"));
    EXPECT_FALSE(is_writing_driver_cache("71 (aftersh:disk$0)"));
    EXPECT_FALSE(is_writing_driver_cache(""));
}

TEST(DriverCache, IsNotWaitedForWhereNothingWritesIt) {
    const auto begin = std::chrono::steady_clock::now();
    wait_for_driver_cache();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

}  // namespace
}  // namespace aftershade::gpu
