// Values in the bytes of a uniform block.
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

namespace aftershade::test {

/// The test fails where the block is too short.
template <typename T>
T value_at(const std::vector<std::byte>& block, std::size_t offset) {
    T value{};
    EXPECT_LE(offset + sizeof(T), block.size());
    if (offset + sizeof(T) <= block.size()) std::memcpy(&value, block.data() + offset, sizeof(T));
    return value;
}

}  // namespace aftershade::test
