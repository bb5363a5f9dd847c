#include "framework/base/whole_number.h"

#include <gtest/gtest.h>

namespace aftershade::test {
namespace {

TEST(WholeNumber, IsTheWholeTextOrNone) {
    EXPECT_EQ(whole_number("12"), 12);
    EXPECT_EQ(whole_number("-3"), -3);
    for (const char* text : {"", " 1", "1 ", "+1", "1.0", "0x1", "2147483648"})
        EXPECT_EQ(whole_number(text), std::nullopt) << text;
}

}  // namespace
}  // namespace aftershade::test
