#include "framework/core/text.h"

#include <cstring>
#include <string>

#include <gtest/gtest.h>

namespace aftershade {
namespace {

std::uint64_t hash(const std::string& text) {
    return fnv1a(std::as_bytes(std::span(text)));
}

// The vectors of the authors' own test suite (http://www.isthe.com/chongo/src/fnv/test_fnv.c).
TEST(Fnv1a, GivesThePublishedHashes) {
    EXPECT_EQ(hash(""), 0xcbf29ce484222325ull);
    EXPECT_EQ(hash("a"), 0xaf63dc4c8601ec8cull);
    EXPECT_EQ(hash("foobar"), 0x85944171f73967e8ull);
}

TEST(Fnv1a, GoesOnWhereItEnded) {
    const std::string tail = "bar";
    EXPECT_EQ(fnv1a(std::as_bytes(std::span(tail)), hash("foo")), hash("foobar"));
}

TEST(SnakeCase, BeginsWithALetterAndHasNoCapitals) {
    for (const char* name : {"a", "a1", "near_tile", "a_"}) EXPECT_TRUE(is_snake_case(name)) << name;
    for (const char* name : {"", "_a", "1a", "nearTile", "a-b", "a b", "\xc3\xa4"})
        EXPECT_FALSE(is_snake_case(name)) << name;
}

}  // namespace
}  // namespace aftershade
