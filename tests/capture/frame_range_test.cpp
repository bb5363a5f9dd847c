#include "framework/capture/frame_range.h"

#include <gtest/gtest.h>

#include <limits>

namespace aftershade {
namespace {

using Frames = std::vector<int>;

TEST(FrameRange, ReadsWhatPeopleWrite) {
    const std::vector<std::pair<std::string, Frames>> ranges = {
        {"7", {7}},
        {"-7", {-7}},
        {"0007", {7}},
        {"1-5", {1, 2, 3, 4, 5}},
        {"1-10x3", {1, 4, 7, 10}},
        {"1-10:2", {1, 3, 5, 7, 9}},
        {"1..3", {1, 2, 3}},
        {"1..9x4", {1, 5, 9}},
        {"-5--1", {-5, -4, -3, -2, -1}},
        {"-2-1", {-2, -1, 0, 1}},
        {"1--1", {1, 0, -1}},
        {"-3..-1", {-3, -2, -1}},
        {"5-1", {5, 4, 3, 2, 1}},
        {"10-1x4", {10, 6, 2}},
        {"3-3", {3}},
        {"1-2x9", {1}},
        {"9,1,5", {9, 1, 5}},
        {" 1 - 2", {}},  // spaces stand around a piece, not in it
        {" 1-2 , 8 ", {1, 2, 8}},
        {"1-4,2-6", {1, 2, 3, 4, 5, 6}},  // what is named again is dropped
        {"3,3,3", {3}},
        {"999999999", {999999999}},
    };
    for (const auto& [text, frames] : ranges)
        EXPECT_EQ(parse_frame_range(text).value_or(Frames{}), frames) << text;
}

TEST(FrameRange, TakesEverySecondFrameAndOneMore) {
    const auto frames = parse_frame_range("1-100x2,120");
    ASSERT_TRUE(frames.has_value());
    ASSERT_EQ(frames->size(), 51U);
    for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ((*frames)[i], int(i) * 2 + 1);
    EXPECT_EQ(frames->back(), 120);
}

TEST(FrameRange, RefusesNonsense) {
    for (const char* text : {"",      " ",   ",",    "1,",    ",1",          "1,,2",          "a",
                             "1-",    "-",   "--1",  "1-2-3", "1-5x",        "1-5x0",         "1-5x-1",
                             "1-5:0", "x2",  "5x2",  "1.5",   "1...3",       "1-5xx2",        "+1",
                             "1;2",   "1 2", "0x10", "1e3",   "99999999999", "1-99999999999", "\u0663"})
        EXPECT_FALSE(parse_frame_range(text).has_value()) << text;
}

TEST(FrameRange, IsRefusedWithALimitOrAnExample) {
    EXPECT_EQ(frame_range_fault("1-100x2,120"), "");
    for (const char* nonsense : {"1-", "x", "1-5x0", "1,,2"})
        EXPECT_EQ(frame_range_fault(nonsense), "not a frame range such as 1-100x2,120") << nonsense;
    for (const char* long_range : {"1-1000001", "1-1000000000", "1-900000,1000000-1900000"})
        EXPECT_TRUE(
            frame_range_fault(long_range).starts_with("too long: a range names at most 1000000 frames"))
            << long_range;
}

TEST(FrameRange, HoldsUpToAMillionFrames) {
    EXPECT_EQ(parse_frame_range("1-1000000").value_or(Frames{}).size(), 1000000U);
    EXPECT_FALSE(parse_frame_range("0-1000000").has_value());
    EXPECT_FALSE(parse_frame_range("-999999999-999999999").has_value());
    EXPECT_EQ(parse_frame_range("-999999999-999999999x999999999").value_or(Frames{}),
              (Frames{-999999999, 0, 999999999}));
    EXPECT_FALSE(parse_frame_range("1-600000,600001-1200000").has_value()) << "together more than a million";
}

struct PatternCase {
    std::string pattern;
    int frame;
    std::string path;
};

const std::vector<PatternCase> kPatterns = {
    {"f_####.exr", 4, "f_0004.exr"},
    {"f_####.exr", 12345, "f_12345.exr"},
    {"f_####.exr", -5, "f_-005.exr"},
    {"f_#.exr", 10, "f_10.exr"},
    {"f_#.exr", -1, "f_-1.exr"},
    {"f_%04d.exr", 42, "f_0042.exr"},
    {"f_%04d.exr", -42, "f_-042.exr"},  // as printf does
    {"f_%d.exr", -42, "f_-42.exr"},
    {"f_%d.exr", 7, "f_7.exr"},
    {"f_@.exr", 7, "f_7.exr"},
    {"f_@@@.exr", 7, "f_007.exr"},
    {"shots/##/f_##.exr", 7, "shots/##/f_07.exr"},  // only the file's name is open
    {"####", 3, "0003"},
};

TEST(FramePattern, WritesTheFrameIntoTheName) {
    for (const PatternCase& test : kPatterns) {
        const FramePattern pattern(test.pattern);
        EXPECT_TRUE(pattern.has_frame()) << test.pattern;
        EXPECT_EQ(pattern.path(test.frame), test.path);
    }
}

TEST(FramePattern, FindsTheFrameInTheNameAgain) {
    for (const PatternCase& test : kPatterns)
        EXPECT_EQ(FramePattern(test.pattern).match(test.path), test.frame) << test.pattern;
    const int lowest = std::numeric_limits<int>::min();
    EXPECT_EQ(FramePattern("#").path(lowest), "-2147483648");
    EXPECT_EQ(FramePattern("#").match("-2147483648"), lowest);
}

TEST(FramePattern, DoesNotMatchNamesThatItWouldNotWrite) {
    const FramePattern pattern("f_####.exr");
    for (const char* name : {"f_004.exr", "f_00004.exr", "f_0004.png", "g_0004.exr", "f_.exr", "f_00a4.exr",
                             "f_-00.exr", "f_+004.exr", "f_ 004.exr", "f_0004.exr2", "", "f_99999999999.exr"})
        EXPECT_EQ(pattern.match(name), std::nullopt) << name;
}

TEST(FrameRange, IsWrittenAsShortAsItCanBeReadAgain) {
    const std::vector<std::pair<Frames, std::string>> lists = {
        {{}, ""},
        {{7}, "7"},
        {{1, 2}, "1-2"},
        {{1, 2, 3, 4, 5}, "1-5"},
        {{1, 3, 5, 120}, "1-5x2,120"},
        {{1, 3}, "1,3"},
        {{9, 1, 5}, "9,1,5"},
        {{10, 6, 2}, "10-2x4"},
        {{-5, -4, -3}, "-5--3"},
        {{1, 2, 3, 5, 6, 7}, "1-3,5-7"},
        {{-999999999, 999999999}, "-999999999,999999999"},
    };
    for (const auto& [frames, text] : lists) {
        EXPECT_EQ(format_frame_range(frames), text);
        EXPECT_TRUE(frames.empty() || parse_frame_range(text) == frames) << text;
    }
}

TEST(FramePattern, WithoutAPlaceholderIsTheOneFile) {
    const FramePattern pattern("shots/####/still.exr");
    EXPECT_FALSE(pattern.has_frame());
    EXPECT_EQ(pattern.path(9), "shots/####/still.exr");
    EXPECT_EQ(pattern.match("shots/####/still.exr"), std::nullopt);
}

TEST(FrameInName, IsTheLastGroupOfDigits) {
    EXPECT_EQ(frame_in_name("gbuffer_0004"), 4);
    EXPECT_EQ(frame_in_name("v2_beauty.0100"), 100);
    EXPECT_EQ(frame_in_name("shot12_final"), 12);
    EXPECT_EQ(frame_in_name("0"), 0);
    EXPECT_EQ(frame_in_name("beauty"), std::nullopt);
    EXPECT_EQ(frame_in_name(""), std::nullopt);
    EXPECT_EQ(frame_in_name("date_20240101123456"), std::nullopt);  // more than an int holds
}

}  // namespace
}  // namespace aftershade
