// The legend's numbers against letters drawn here.
#include <array>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "effects/visualize/visualize_test.h"

namespace aftershade::test::visualize_legend {
namespace {

/// Digits of the legend, row by row.
const std::map<char, std::array<const char*, 7>> kLetters = {
    {'0', {".###.", "#...#", "#..##", "#.#.#", "##..#", "#...#", ".###."}},
    {'1', {"..#..", ".##..", "..#..", "..#..", "..#..", "..#..", ".###."}},
    {'2', {".###.", "#...#", "....#", "...#.", "..#..", ".#...", "#####"}},
    {'3', {"#####", "...#.", "..#..", "...#.", "....#", "#...#", ".###."}},
    {'4', {"...#.", "..##.", ".#.#.", "#..#.", "#####", "...#.", "...#."}},
    {'5', {"#####", "#....", "####.", "....#", "....#", "#...#", ".###."}},
    {'6', {"..##.", ".#...", "#....", "####.", "#...#", "#...#", ".###."}},
    {'7', {"#####", "....#", "...#.", "..#..", ".#...", ".#...", ".#..."}},
    {'8', {".###.", "#...#", "#...#", ".###.", "#...#", "#...#", ".###."}},
    {'9', {".###.", "#...#", "#...#", ".####", "....#", "...#.", ".##.."}},
    {'.', {".....", ".....", ".....", ".....", ".....", ".##..", ".##.."}},
    {'-', {".....", ".....", ".....", "#####", ".....", ".....", "....."}},
    {'e', {".....", ".....", ".###.", "#...#", "#####", "#....", ".###."}},
    {' ', {".....", ".....", ".....", ".....", ".....", ".....", "....."}},
    {'p', {".....", ".....", "####.", "#...#", "#...#", "####.", "#...."}},
    {'x', {".....", ".....", "#...#", ".#.#.", "..#..", ".#.#.", "#...#"}},
    {'m', {".....", ".....", "##.#.", "#.#.#", "#.#.#", "#...#", "#...#"}},
};

bool is_ink(const Image& image, int x, int y) {
    return at(image, x, y) == DisplayColor{0.9f, 0.9f, 0.9f};
}

/// Whether the text stands somewhere, dots of dot_px, with nothing right before or behind it.
bool reads(const Image& image, const std::string& text, int dot_px = 1) {
    const int width = 6 * int(text.size());
    const auto stands_at = [&](int left, int top) {
        for (int row = 0; row < 7; ++row)
            for (int column = -5; column < width + 5; ++column) {
                const int x = left + column * dot_px, y = top + row * dot_px;
                const bool beside = column < 0 || column >= width || column % 6 == 5;
                const bool dot =
                    !beside &&
                    kLetters.at(text[std::size_t(column / 6)])[std::size_t(row)][column % 6] == '#';
                if (x < 0 || x >= image.width()) continue;
                if (is_ink(image, x, y) != dot || is_ink(image, x + dot_px - 1, y + dot_px - 1) != dot)
                    return false;
            }
        return true;
    };
    for (int top = 0; top + 7 * dot_px <= image.height(); ++top)
        for (int left = 0; left + width * dot_px <= image.width(); ++left)
            if (stands_at(left, top)) return true;
    return false;
}

TEST(VisualizeLegend, TheLegendsNumberReadsTheMaximum) {
    const Capture capture = moving(240, 135, 0, 0);
    struct Case {
        const char* max;
        const char* text;
    };
    for (const Case& c : {Case{"12", "12 px"},
                          {"0.5", "0.5 px"},
                          {"345", "345 px"},
                          {"67.89", "67.89 px"},
                          {"999.96", "1000 px"},
                          {"123456", "123456 px"},
                          {"1000000", "1e6 px"},
                          {"0.0025", "0.0025 px"},
                          {"0.00001234", "1.234e-5 px"}}) {
        const Image image = shown(capture, R"("max": )" + std::string(c.max));
        EXPECT_TRUE(reads(image, c.text)) << c.max;
        EXPECT_FALSE(reads(image, "21 px")) << c.max;
    }
}

TEST(VisualizeLegend, WithoutAMaximumTheScaleEndsAtTheNextRoundNumber) {
    struct Case {
        float longest;
        const char* text;
    };
    for (const Case& c : {Case{13.7f, "20 px"},
                          {20, "20 px"},
                          {20.1f, "50 px"},
                          {0.3f, "0.5 px"},
                          {700, "1000 px"},
                          {0, "1 px"}}) {
        Capture capture = moving(240, 135, 0, 0);
        set_velocity(capture, 239, 134, 0, -c.longest);
        EXPECT_TRUE(reads(shown(capture, ""), c.text)) << c.longest;
    }
}

TEST(VisualizeLegend, TheLegendHasBothEndsTheMiddleAndAUnit) {
    Capture capture = moving(240, 135, 0, 0);
    const Image depth = shown(capture, R"("show": "depth", "near": 1, "far": 16)");
    for (const char* text : {"1", "4", "16 m"}) EXPECT_TRUE(reads(depth, text)) << text;
    const Image linear = shown(capture, R"("show": "depth", "near": 1, "far": 16, "depth_scale": "linear")");
    EXPECT_TRUE(reads(linear, "8.5"));
    const std::string in = R"(, "in": {"image": "capture.mask"})";
    const Image signed_ = shown(capture, R"("show": "signed", "max": 2.5, "unit": "px")", in);
    for (const char* text : {"-2.5", "0", "2.5 px"}) EXPECT_TRUE(reads(signed_, text)) << text;
    const Image scalar = shown(capture, R"("show": "scalar", "low": -3, "high": 1)", in);
    for (const char* text : {"-3", "-1", "1"}) EXPECT_TRUE(reads(scalar, text)) << text;
}

TEST(VisualizeLegend, TheLegendGrowsWithThePictureAndCanBeOff) {
    const Capture capture = moving(960, 540, 0, 0);
    EXPECT_TRUE(reads(shown(capture, R"("max": 12)"), "12 px", 2));
    const Image without = shown(capture, R"("max": 12, "legend": false)");
    for (const float value : {without.at(20, 500, 0), without.at(100, 450, 1)}) EXPECT_EQ(value, 0.0f);
}

TEST(VisualizeLegend, TheWheelItselfIsTheLegend) {
    const Image image = shown(moving(240, 135, 0, 0), R"("max": 12)");
    // The panel of 64 x 66 px lies 4 px from the lower left corner, the wheel's middle 33 px below its top.
    const int x = 4 + 32, y = 135 - 4 - 66 + 33;
    for (const auto& [dx, dy] : {std::pair(12, 0), {0, 12}, {-9, 5}, {3, -14}})
        expect_color(image, x + dx, y + dy, wheel_color((float(dx) + 0.5f) / 20, (float(dy) + 0.5f) / 20),
                     "wheel");
}

TEST(VisualizeLegend, TheLegendLiesInItsCorner) {
    const Capture capture = moving(240, 160, 0, 0);
    const Image without = shown(capture, R"("legend": false)");
    struct Case {
        const char* corner;
        bool right, bottom;
    };
    for (const Case& c : {Case{"bottom_left", false, true},
                          {"bottom_right", true, true},
                          {"top_left", false, false},
                          {"top_right", true, false}}) {
        const Image image = shown(capture, R"("corner": ")" + std::string(c.corner) + "\"");
        int changed = 0;
        for (int y = 0; y < 160; ++y)
            for (int x = 0; x < 240; ++x) {
                if (at(image, x, y) == at(without, x, y)) continue;
                ++changed;
                EXPECT_TRUE((x >= 120) == c.right && (y >= 80) == c.bottom) << c.corner << x << " " << y;
            }
        EXPECT_GT(changed, 1000) << c.corner;
    }
}

TEST(VisualizeLegend, TheLegendTellsLoudColorsOnlyWhereThePictureHasThem) {
    Capture capture = moving(240, 135, 0, 0);
    const auto count = [](const Image& image, PixelFault fault) {
        int pixels = 0;
        for (int y = 40; y < 135; ++y)
            for (int x = 0; x < 120; ++x) pixels += at(image, x, y) == pixel_fault_color(fault);
        return pixels;
    };
    EXPECT_EQ(count(shown(capture, ""), PixelFault::nan), 0);
    set_velocity(capture, 200, 10, std::numeric_limits<float>::quiet_NaN(), 0);
    const Image image = shown(capture, "");
    EXPECT_EQ(count(image, PixelFault::nan), 7 * 7);
    EXPECT_EQ(count(image, PixelFault::infinite), 0);
}

}  // namespace
}  // namespace aftershade::test::visualize_legend
