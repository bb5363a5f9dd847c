// glsl/hash.glsl and glsl/sequence.glsl against published vectors and, bit by bit, against their twin.
#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/backends.h"
#include "tests/glsl/shader_table.h"
#include "tests/reference/sequence.h"

namespace aftershade::test {
namespace {

using reference::pcg3d;
using reference::pcg3d16;
using reference::Uvec2;
using reference::Uvec3;

TEST(SequenceTwin, GivesTheHashesOfTheReference) {
    EXPECT_EQ(pcg3d16({0, 0, 0}), (Uvec3{47928, 18063, 47824}));
    EXPECT_EQ(pcg3d16({1, 2, 3}), (Uvec3{20732, 51808, 35516}));
    EXPECT_EQ(pcg3d16({640, 360, 7}), (Uvec3{60037, 54304, 20406}));
    EXPECT_EQ(pcg3d({0, 0, 0}), (Uvec3{0x9bafd7c6, 0xa8e88a6b, 0x3f15482c}));
    EXPECT_EQ(pcg3d({1, 2, 3}), (Uvec3{0xfa9f79a6, 0x48f2f44c, 0x596f5ab1}));
}

TEST(SequenceTwin, GivesThePointsOfTheReference) {
    const Uvec2 middle{0x80000000u, 0x80000000u};
    const double expected[3][2] = {{0.254878, 0.069840}, {0.009755, 0.639681}, {0.764633, 0.209521}};
    for (std::uint32_t i = 1; i <= 3; ++i)
        for (std::size_t c = 0; c < 2; ++c)
            EXPECT_NEAR(reference::r2_point(middle, i)[c], expected[i - 1][c], 1e-6) << i;
}

/// In units of 2^-32 a step is off by at most half a unit, which i steps make i / 2.
TEST(SequenceTwin, StepsByTheRootOfItsCubic) {
    const long double phi = 1.32471795724474602596L;
    EXPECT_NEAR(double(phi * phi * phi - phi - 1), 0, 1e-15);
    const Uvec2 step = reference::r2_bits({0, 0}, 1);
    EXPECT_LE(std::abs(std::ldexp(1 / phi, 32) - step[0]), 0.5L);
    EXPECT_LE(std::abs(std::ldexp(1 / (phi * phi), 32) - step[1]), 0.5L);
}

/// Of N even points no square of a fine grid has more than a few; of random ones some have 7.
TEST(SequenceTwin, FillsTheSquareEvenly) {
    constexpr int kSide = 64;
    for (const Uvec2& start : {reference::r2_start({3, 5}, 1), reference::r2_start({100, 7}, 2)}) {
        std::vector<int> cells(kSide * kSide);
        for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
            const auto point = reference::r2_point(start, i);
            ++cells[std::size_t(point[1] * kSide) * kSide + std::size_t(point[0] * kSide)];
        }
        EXPECT_LE(*std::max_element(cells.begin(), cells.end()), 3);
    }
}

TEST(SequenceTwin, NeverGivesZeroOrOne) {
    EXPECT_EQ(reference::unit_float(0), 0x1p-24f);
    EXPECT_EQ(reference::unit_float(0xffffffffu), 1 - 0x1p-24f);
}

class SequenceShader : public gpu::OnEachBackend {
protected:
    static constexpr int kCount = 4096;
    static Image table(const std::string& expression) {
        return shader_table("#include <sequence.glsl>\n", expression, kCount, "rgba32ui", GetParam());
    }
    /// Arguments that differ in all bits, as the shader makes them of i too.
    static Uvec3 arguments(std::uint32_t i) { return {i, i * 2654435761u, ~(i << 19u)}; }
    static constexpr const char* kArguments = "uvec3(uint(i), uint(i) * 2654435761u, ~(uint(i) << 19u))";
};

TEST_P(SequenceShader, HashesBitByBitAsTheTwin) {
    const Image wide = table("uvec4(pcg3d(" + std::string(kArguments) + "), 0u)");
    const Image narrow = table("uvec4(pcg3d16(" + std::string(kArguments) + "), 0u)");
    for (int i = 0; i < kCount; ++i)
        for (int c = 0; c < 3; ++c) {
            ASSERT_EQ(wide.uint_at(i, 0, c), pcg3d(arguments(std::uint32_t(i)))[std::size_t(c)]) << i;
            ASSERT_EQ(narrow.uint_at(i, 0, c), pcg3d16(arguments(std::uint32_t(i)))[std::size_t(c)]) << i;
        }
}

TEST_P(SequenceShader, GoesOnBitByBitAsTheTwinForMillionsOfPoints) {
    const Image points = table(
        "uvec4(r2_bits(r2_start(uvec2(i, 7), 9u), uint(i) * 1000003u), "
        "floatBitsToUint(r2_point(r2_start(uvec2(i, 7), 9u), uint(i) * 1000003u)))");
    for (int i = 0; i < kCount; ++i) {
        const Uvec2 start = reference::r2_start({std::uint32_t(i), 7}, 9);
        const Uvec2 bits = reference::r2_bits(start, std::uint32_t(i) * 1000003u);
        const auto point = reference::r2_point(start, std::uint32_t(i) * 1000003u);
        for (int c = 0; c < 2; ++c) {
            ASSERT_EQ(points.uint_at(i, 0, c), bits[std::size_t(c)]) << i;
            ASSERT_EQ(points.uint_at(i, 0, 2 + c), std::bit_cast<std::uint32_t>(point[std::size_t(c)])) << i;
        }
    }
}

ON_EACH_BACKEND(SequenceShader);

}  // namespace
}  // namespace aftershade::test
