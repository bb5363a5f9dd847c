// Draws over tile lists and copies, by small effects.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/backends.h"
#include "tests/render/effect_fixture.h"

namespace aftershade::test {
namespace {

// No side is a multiple of a tile's, and level 2 loses a row and a column of level 1.
constexpr int kTiledWidth = 75, kTiledHeight = 54, kTilePx = 16;

Capture tiled_picture() {
    return make_capture({.width = kTiledWidth, .height = kTiledHeight, .background = {0.5f, 0.25f, 1}});
}

bool is_chosen_tile(int tile_x, int tile_y) {
    return (tile_x + tile_y) % 2 == 0;
}

/// Lists every other tile, draws a number for each texel over them and shows what then is at a pixel: red at
/// level 1, green at level 2, blue in blocks of 8 px, alpha at full size.
const char* const kTiled =
    R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
    "textures": { "marks": { "format": "r8", "tile": 16, "doc": "." },
                  "levels": { "format": "r32f", "mips": 3, "clear": -1, "doc": "." },
                  "blocks": { "format": "r32f", "tile": 8, "clear": -1, "doc": "." },
                  "whole": { "format": "r32f", "clear": -1, "doc": "." } },
    "tiles": { "chosen": { "of": "marks.r", "doc": "." } },
    "passes": [
        { "name": "mark", "shader": "main.frag", "reads": ["color"], "writes": ["marks"], "defines": { "MARK": 1 } },
        { "name": "one", "shader": "main.frag", "reads": [], "writes": [{ "levels": { "level": 1 } }], "over": "chosen", "defines": { "OUT": "out_levels" } },
        { "name": "two", "shader": "main.frag", "reads": [], "writes": [{ "levels": { "level": 2 } }], "over": "chosen", "defines": { "OUT": "out_levels" } },
        { "name": "block", "shader": "main.frag", "reads": [], "writes": ["blocks"], "over": "chosen", "defines": { "OUT": "out_blocks" } },
        { "name": "full", "shader": "main.frag", "reads": [], "writes": ["whole"], "over": "chosen", "defines": { "OUT": "out_whole" } },
        { "name": "show", "shader": "main.frag", "reads": ["levels", "blocks", "whole"], "writes": ["color"], "defines": { "SHOW": 1 } } ])";

const char* const kTiledShader = R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#if defined(MARK)
    out_marks = (p.x + p.y) % 2 == 0 ? texelFetch(color, ivec2(0), 0).b : 0.0;
#elif defined(SHOW)
    ivec2 one = min(p >> 1, (frame.size >> 1) - 1), two = min(p >> 2, (frame.size >> 2) - 1);
    out_color = vec4(texelFetch(levels, one, 1).r, texelFetch(levels, two, 2).r, texelFetch(blocks, p >> 3, 0).r,
                     texelFetch(whole, p, 0).r);
#else
    OUT = float(p.x + 100 * p.y);
#endif
}
)";

TEST(TilesOfAPass, LieOnLevelsAndOnBlocksToo) {
    EffectFolder effects;
    effects.add("tiled", kTiled, kTiledShader);
    const Image shown = Bench(effects, look_of(R"({"effect": "tiled"})")).color(tiled_picture());
    // The number of the texel of `side` px that p lies in, where a chosen tile has it.
    const auto expected = [](int x, int y, int side, int width, int height) {
        const int i = std::min(x / side, width - 1), k = std::min(y / side, height - 1);
        return is_chosen_tile(i * side / kTilePx, k * side / kTilePx) ? float(i + 100 * k) : -1.0f;
    };
    for (int y = 0; y < kTiledHeight; ++y)
        for (int x = 0; x < kTiledWidth; ++x) {
            ASSERT_EQ(shown.at(x, y, 0), expected(x, y, 2, kTiledWidth / 2, kTiledHeight / 2))
                << x << ", " << y;
            ASSERT_EQ(shown.at(x, y, 1), expected(x, y, 4, kTiledWidth / 4, kTiledHeight / 4))
                << x << ", " << y;
            ASSERT_EQ(shown.at(x, y, 2), expected(x, y, 8, 10, 7)) << x << ", " << y;
            ASSERT_EQ(shown.at(x, y, 3), expected(x, y, 1, kTiledWidth, kTiledHeight)) << x << ", " << y;
        }
}

/// A texture with room to the right of the frame's pixels and below: one list's tiles are the frame's, the
/// other's lie in the room alone.
const char* const kRoom =
    R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
    "textures": { "marks": { "format": "r8", "tile": 16, "doc": "." },
                  "wide": { "format": "r32f", "room": [0.5, 0.25], "clear": -1, "doc": "." } },
    "tiles": { "chosen": { "of": "marks.r", "doc": "." },
               "beyond": { "predicate": "beyond.glsl", "tile": 16, "on": "wide", "doc": "." } },
    "passes": [
        { "name": "mark", "shader": "main.frag", "reads": ["color"], "writes": ["marks"], "defines": { "MARK": 1 } },
        { "name": "frame", "shader": "main.frag", "reads": [], "writes": ["wide"], "over": "chosen", "defines": { "OUT": "out_wide" } },
        { "name": "room", "shader": "main.frag", "reads": [], "writes": ["wide"], "over": "beyond", "defines": { "OUT": "out_wide" } },
        { "name": "show", "shader": "main.frag", "reads": ["wide"], "writes": ["color"], "defines": { "SHOW": 1 } } ])";

const char* const kRoomShader = R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#if defined(MARK)
    out_marks = (p.x + p.y) % 2 == 0 ? texelFetch(color, ivec2(0), 0).b : 0.0;
#elif defined(SHOW)
    ivec2 far = p + ivec2(wide_size.xy) - frame.size;
    out_color = vec4(texelFetch(wide, p, 0).r, texelFetch(wide, far, 0).r, wide_size.xy);
#else
    OUT = float(p.x + 1000 * p.y);
#endif
}
)";

TEST(TilesOfAPass, LieInTheRoomBesideAFrameToo) {
    EffectFolder effects;
    effects.add("room", kRoom, kRoomShader);
    write_text(
        effects.path() / "room" / "beyond.glsl",
        "bool beyond(ivec2 tile) { return any(greaterThanEqual(16 * tile, frame.size + 63 & ~63)); }\n");
    const std::string look = look_of(R"({"effect": "room"})");
    Bench bench(effects, look);
    constexpr int kRoomX = 128, kRoomY = 64, kWideWidth = kRoomX + 38, kWideHeight = kRoomY + 14;
    const auto expected = [](int x, int y) {
        const int i = x / kTilePx, k = y / kTilePx;
        const bool is_beyond = x >= kRoomX || y >= kRoomY;
        const bool is_framed = i * kTilePx < kTiledWidth && k * kTilePx < kTiledHeight;
        return is_beyond || (is_framed && is_chosen_tile(i, k)) ? float(x + 1000 * y) : -1.0f;
    };
    for (int frame = 0; frame < 2; ++frame) {
        const Image shown = bench.color(tiled_picture());
        for (int y = 0; y < kTiledHeight; ++y)
            for (int x = 0; x < kTiledWidth; ++x) {
                ASSERT_EQ(shown.at(x, y, 0), expected(x, y)) << x << ", " << y;
                ASSERT_EQ(shown.at(x, y, 1),
                          expected(x + kWideWidth - kTiledWidth, y + kWideHeight - kTiledHeight))
                    << x << ", " << y;
                ASSERT_EQ(shown.at(x, y, 2), kWideWidth);
                ASSERT_EQ(shown.at(x, y, 3), kWideHeight);
            }
    }
}

/// As kTiled, but which tiles of three are chosen depends on the picture's red.
TEST(TilesOfAPass, LeaveNothingBehindForTheNextFrame) {
    EffectFolder effects;
    std::string shader = kTiledShader;
    const std::string chosen = "(p.x + p.y) % 2 == 0";
    shader.replace(shader.find(chosen), chosen.size(),
                   "(p.x + p.y) % 3 == int(texelFetch(color, ivec2(0), 0).r)");
    effects.add("tiled", kTiled, shader);
    const std::string look = look_of(R"({"effect": "tiled"})");
    Bench bench(effects, look);
    for (const float red : {0.0f, 2.0f, 3.0f, 1.0f, 1.0f}) {  // 3: no tile
        const Capture picture =
            make_capture({.width = kTiledWidth, .height = kTiledHeight, .background = {red, 0.25f, 1}});
        const Image first_frame = Bench(effects, look).color(picture), shown = bench.color(picture);
        ASSERT_TRUE(std::ranges::equal(shown.floats(), first_frame.floats())) << red;
    }
}

/// Draws a picture's red to the tiles of one row, which depends on its green, and shows them elsewhere zero.
/// With PEEK the last pass looks at a texel that none drew.
const char* const kPartial =
    R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
    "textures": { "marks": { "format": "r8", "tile": 16, "doc": "." },
                  "before": { "format": "rgba32ui", "doc": "." }, "counted": { "format": "r32f", "doc": "." },
                  "bits": { "format": "rgba32ui", "partial": true, "doc": "." } },
    "tiles": { "chosen": { "of": "marks.r", "doc": "." } },
    "passes": [
        { "name": "mark", "shader": "main.frag", "reads": ["color"], "writes": ["marks"], "defines": { "MARK": 1 } },
        { "name": "fill", "shader": "main.frag", "reads": ["color"], "writes": ["before"], "defines": { "FILL": 1 } },
        { "name": "count", "shader": "main.frag", "reads": ["before"], "writes": ["counted"], "defines": { "COUNT": 1 } },
        { "name": "draw", "shader": "main.frag", "reads": ["color"], "writes": ["bits"], "over": "chosen", "defines": { "DRAW": 1 } },
        { "name": "show", "shader": "main.frag", "reads": ["bits", "marks", "counted"], "writes": ["color"] } ])";

const char* const kPartialShader = R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#if defined(MARK)
    out_marks = p.y == int(texelFetch(color, ivec2(0), 0).g) ? 1.0 : 0.0;
#elif defined(FILL)
    out_before = floatBitsToUint(texelFetch(color, p, 0)) ^ 0x5555u;
#elif defined(COUNT)
    out_counted = texelFetch(before, p, 0).a == 0u ? 0.0 : 1.0;
#elif defined(DRAW)
    out_bits = floatBitsToUint(texelFetch(color, p, 0));
#else
    bool is_drawn = texelFetch(marks, p / 16, 0).r > 0.5 || PEEKS;
    out_color = is_drawn ? uintBitsToFloat(texelFetch(bits, p, 0)) : vec4(0.0, 0.0, 0.0, texelFetch(counted, p, 0).r);
#endif
}
)";

std::string partial_shader(bool peeks) {
    return std::string("\nconst bool PEEKS = ") + (peeks ? "true" : "false") + ";" + kPartialShader;
}

Capture picture_of_row(int row) {
    return make_capture({.width = kTiledWidth, .height = kTiledHeight, .background = {0.5f, float(row), 1}});
}

TEST(PartialTextures, ShowTheSameWhateverLayInTheirMemory) {
    EffectFolder effects;
    effects.add("partial", kPartial, partial_shader(false));
    const std::string look = look_of(R"({"effect": "partial"})");
    Bench bench(effects, look);
    for (const int row : {0, 2, 99, 1, 1}) {  // 99: no tile
        const Image shown = bench.color(picture_of_row(row)),
                    first = Bench(effects, look).color(picture_of_row(row));
        ASSERT_TRUE(std::ranges::equal(shown.floats(), first.floats())) << row;
        for (int y = 0; y < kTiledHeight; ++y)
            ASSERT_EQ(shown.at(3, y, 0), y / kTilePx == row ? 0.5f : 0.0f) << row << ", " << y;
    }
}

TEST(PartialTextures, HaveEveryBitSetWhereATapShowsWhatNoPassDrew) {
    EffectFolder effects;
    effects.add("partial", kPartial, partial_shader(false));
    PipelineOptions options;
    options.taps = {"partial.bits"};
    Bench bench(effects, look_of(R"({"effect": "partial"})"), options);
    for (const int row : {1, 0}) {
        const Image bits = bench.run(picture_of_row(row)).taps.at("partial.bits");
        for (int y = 0; y < kTiledHeight; ++y)
            ASSERT_EQ(bits.uint_at(5, y, 0),
                      y / kTilePx == row ? std::bit_cast<std::uint32_t>(0.5f) : UINT32_MAX)
                << y;
    }
}

TEST(PartialTextures, LetAnAuditFindThePassThatReadsWhatNoneDrew) {
    for (const bool peeks : {false, true}) {
        EffectFolder effects;
        effects.add("partial", kPartial, partial_shader(peeks));
        Bench bench(effects, look_of(R"({"effect": "partial"})"), {}, gpu::test_backend(), {.audits = true});
        const std::vector<AuditFinding> found = bench.run(picture_of_row(1)).audit;
        ASSERT_EQ(found.empty(), !peeks);
        if (!peeks) continue;
        EXPECT_EQ(found.front().pass, "partial.show");
    }
}

const char* const kCopied =
    R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
    "textures": { "marks": { "format": "r8", "tile": 16, "doc": "." } },
    "tiles": { "chosen": { "of": "marks.r", "doc": "." } },
    "passes": [
        { "name": "mark", "shader": "main.frag", "reads": ["color"], "writes": ["marks"], "defines": { "MARK": 1 } },
        { "name": "sharp", "kind": "copy", "from": "color", "to": "color" },
        { "name": "ones", "shader": "main.frag", "reads": [], "writes": ["color"], "over": "chosen" } ])";

const char* const kCopiedShader = R"(
void main() {
#ifdef MARK
    out_marks = ivec2(gl_FragCoord.xy) == ivec2(1) ? 1.0 : 0.0 * texelFetch(color, ivec2(0), 0).r;
#else
    out_color = vec4(1.0);
#endif
}
)";

bool is_of_ones(int x, int y) {
    return x / kTilePx == 1 && y / kTilePx == 1;
}

TEST(CopyOfAPass, KeepsEveryBitOutsideTheTilesDrawn) {
    EffectFolder effects;
    effects.add("copied", kCopied, kCopiedShader);
    Capture capture = tiled_picture();
    Image& color = capture.images.at("color");
    color.at(40, 3, 0) = std::numeric_limits<float>::quiet_NaN();
    color.at(41, 3, 1) = -std::numeric_limits<float>::infinity();
    color.at(42, 3, 2) = 1e-41f;  // a draw may flush it to 0
    const Image result = Bench(effects, look_of(R"({"effect": "copied"})")).color(capture);
    for (int y = 0; y < kTiledHeight; ++y)
        for (int x = 0; x < kTiledWidth; ++x)
            for (int c = 0; c < 4; ++c) {
                const float want = is_of_ones(x, y) ? 1.0f : color.at(x, y, c);
                ASSERT_EQ(std::bit_cast<std::uint32_t>(result.at(x, y, c)),
                          std::bit_cast<std::uint32_t>(want))
                    << x << ", " << y << ", " << c;
            }
}

/// Draws one more tile of `kept` in each frame, over what the frame before left.
const char* const kKept =
    R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
    "textures": { "marks": { "format": "r8", "tile": 16, "doc": "." },
                  "kept": { "format": "r32f", "history": true, "doc": "." } },
    "tiles": { "chosen": { "of": "marks.r", "doc": "." } },
    "passes": [
        { "name": "mark", "shader": "main.frag", "reads": ["color"], "writes": ["marks"], "defines": { "MARK": 1 } },
        { "name": "before", "kind": "copy", "from": "kept.prev", "to": "kept" },
        { "name": "now", "shader": "main.frag", "reads": ["color"], "writes": ["kept"], "over": "chosen", "defines": { "NOW": 1 } },
        { "name": "show", "shader": "main.frag", "reads": ["kept"], "writes": ["color"] } ])";

const char* const kKeptShader = R"(
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
#if defined(MARK)
    out_marks = ivec2(texelFetch(color, ivec2(0), 0).r, 1) == p ? 1.0 : 0.0;
#elif defined(NOW)
    out_kept = texelFetch(color, ivec2(0), 0).r + 1.0;
#else
    out_color = vec4(texelFetch(kept, p, 0).r);
#endif
}
)";

TEST(CopyOfAPass, BeginsATextureWithWhatTheFrameBeforeLeftInIt) {
    EffectFolder effects;
    effects.add("kept", kKept, kKeptShader);
    Bench bench(effects, look_of(R"({"effect": "kept"})"));
    for (int frame = 0; frame < 4; ++frame) {
        Capture capture =
            make_capture({.width = kTiledWidth, .height = kTiledHeight, .background = {float(frame), 0, 0}});
        capture.header.frame = frame;
        const Image result = bench.color(capture);
        for (int y = 0; y < kTiledHeight; ++y)
            for (int x = 0; x < kTiledWidth; ++x) {
                const int tile = x / kTilePx;
                const bool drawn = y / kTilePx == 1 && tile <= frame;
                ASSERT_EQ(result.at(x, y, 0), drawn ? float(tile + 1) : 0.0f)
                    << "frame " << frame << ": " << x << ", " << y;
            }
    }
}

TEST(CopyOfAPass, ConvertsWhatAnEarlierStepMadeInAnotherFormat) {
    EffectFolder effects;
    effects.add("copied", kCopied, kCopiedShader);
    effects.add(
        "halves",
        R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "textures": { "thirds": { "format": "rgba16f", "doc": "." } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color", "thirds"] } ])",
        "void main() { out_color = texelFetch(color, ivec2(0), 0); out_thirds = vec4(1.0 / 3.0); }\n");
    const std::string look =
        look_of(R"({"effect": "halves"}, {"effect": "copied", "in": {"color": "halves.thirds"}})");
    const Image result = Bench(effects, look).color(tiled_picture());
    EXPECT_EQ(result.at(0, 0, 1), 0.333251953125f) << "a third as a half";
    EXPECT_EQ(result.at(kTilePx, kTilePx, 1), 1.0f);
}

}  // namespace
}  // namespace aftershade::test
