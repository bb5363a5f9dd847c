#include "framework/image/lut.h"

#include "tests/documents.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

namespace aftershade {
namespace {

using test::Lines;

Lines faults_of(const std::string& text) {
    Diagnostics diagnostics;
    EXPECT_FALSE(parse_lut(text, "a.cube", diagnostics).has_value());
    return test::lines_of(diagnostics);
}

Lut lut_of(const std::string& text) {
    Diagnostics diagnostics;
    const auto lut = parse_lut(text, "a.cube", diagnostics);
    EXPECT_EQ(test::lines_of(diagnostics), Lines{}) << text;
    return lut.value_or(Lut{});
}

std::string identity_cube(int size) {
    std::string text = "LUT_3D_SIZE " + std::to_string(size) + "\n";
    for (int b = 0; b < size; ++b)
        for (int g = 0; g < size; ++g)
            for (int r = 0; r < size; ++r) {
                for (const int i : {r, g, b}) text += std::to_string(double(i) / (size - 1)) + " ";
                text += "\n";
            }
    return text;
}

TEST(Lut, OfThreeDimensionsHasRedFastest) {
    const Lut lut = lut_of(identity_cube(5));
    EXPECT_EQ(lut.dimensions, 3);
    ASSERT_EQ(lut.size, 5);
    ASSERT_EQ(lut.values.size(), 3u * 125u);
    std::size_t i = 0;
    for (int b = 0; b < 5; ++b)
        for (int g = 0; g < 5; ++g)
            for (int r = 0; r < 5; ++r)
                for (const int index : {r, g, b}) EXPECT_EQ(lut.values[i++], float(index) / 4);
}

// The first example of the specification, with the white space, comments and line ends that files have.
TEST(Lut, OfOneDimensionKeepsItsDomainAndTitle) {
    const Lut lut = lut_of(
        "#comment\r\nTITLE \"1-D \"demo\"\"\r\n\r\n\tDOMAIN_MIN -0.5 0 0\r\n"
        "DOMAIN_MAX 255.0 2.55e2 +1\r\nLUT_1D_SIZE 3\r\n# another\r\n"
        " 0 0 0\r\n0.25\t.5  1e-1 \r\n1 1 -1");
    EXPECT_EQ(lut.dimensions, 1);
    EXPECT_EQ(lut.size, 3);
    EXPECT_EQ(lut.title, "1-D \"demo\"");
    EXPECT_EQ(lut.domain_min, (std::array<double, 3>{-0.5, 0, 0}));
    EXPECT_EQ(lut.domain_max, (std::array<double, 3>{255, 255, 1}));
    EXPECT_EQ(lut.values, (std::vector<float>{0, 0, 0, 0.25f, 0.5f, 0.1f, 1, 1, -1}));
}

TEST(Lut, TakesResolvesInputRangeForItsDomain) {
    const Lut lut = lut_of("LUT_1D_SIZE 2\nLUT_1D_INPUT_RANGE -0.125 4\n0 0 0\n1 1 1\n");
    EXPECT_EQ(lut.domain_min, (std::array<double, 3>{-0.125, -0.125, -0.125}));
    EXPECT_EQ(lut.domain_max, (std::array<double, 3>{4, 4, 4}));
    EXPECT_EQ(faults_of("LUT_1D_SIZE 2\nLUT_3D_INPUT_RANGE 0 1\n0 0 0\n1 1 1\n"),
              Lines{"a.cube:4:1: error: LUT_3D_INPUT_RANGE does not belong to a table of 1 dimension"});
    EXPECT_EQ(
        faults_of("LUT_1D_SIZE 2\nDOMAIN_MIN 0 0 0\nLUT_1D_INPUT_RANGE 0 1\n0 0 0\n1 1 1\n"),
        Lines{"a.cube:3:1: error: LUT_1D_INPUT_RANGE and DOMAIN_MIN or DOMAIN_MAX are two ways to say the "
              "same, use one"});
}

TEST(Lut, SaysOnWhichLineAFileIsDamaged) {
    EXPECT_EQ(faults_of("TITLE demo\nLUT_3D_SIZ 2\nLUT_1D_SIZE 2.5\nDOMAIN_MIN 0 0\n"),
              (Lines{"a.cube:1:1: error: TITLE needs a text in quotes",
                     "a.cube:2:1: error: 'LUT_3D_SIZ' is not a keyword of a .cube file; did you mean "
                     "'LUT_3D_SIZE'?",
                     "a.cube:3:1: error: LUT_1D_SIZE '2.5' is not a whole number from 2 to 65536",
                     "a.cube:4:1: error: DOMAIN_MIN needs three numbers"}));
    EXPECT_EQ(faults_of("LUT_1D_SIZE 3\n0 0 0\n0.5 x 0.5\n0 1\n"),
              (Lines{"a.cube:3:1: error: expected three numbers, not '0.5 x 0.5'",
                     "a.cube:4:1: error: expected three numbers, not '0 1'"}));
    for (const std::string bad : {"nan", "inf", "-inf", "1e39", "0,5", "0x1", "1e", "--1"})
        EXPECT_EQ(faults_of("LUT_1D_SIZE 2\n0 0 0\n0 " + bad + " 0\n"),
                  Lines{"a.cube:3:1: error: expected three numbers, not '0 " + bad + " 0'"});
    EXPECT_EQ(faults_of("LUT_1D_SIZE 2\n0 0 0 0\n1 1 1\n"),
              Lines{"a.cube:2:1: error: expected three numbers, not '0 0 0 0'"});
    EXPECT_EQ(faults_of("LUT_1D_SIZE 2\n0 0 0\nDOMAIN_MIN 0 0 0\n1 1 1\n"),
              Lines{"a.cube:3:1: error: DOMAIN_MIN must stand before the table"});
    EXPECT_EQ(faults_of("LUT_1D_SIZE 2\nDOMAIN_MAX 1 0 1\n0 0 0\n1 1 1\n"),
              Lines{"a.cube:4:1: error: the domain of g does not rise, it is 0 to 0"});
    EXPECT_EQ(faults_of("LUT_1D_SIZE 2\nLUT_1D_SIZE 2\n0 0 0\n1 1 1\n"),
              Lines{"a.cube:2:1: error: LUT_1D_SIZE stands twice"});
    EXPECT_EQ(faults_of("LUT_1D_SIZE 2\nLUT_3D_SIZE 2\n"),
              Lines{"a.cube:2:1: error: both LUT_1D_SIZE and LUT_3D_SIZE: a curve in front of a cube is not "
                    "supported, bake it into one table"});
}

TEST(Lut, HasAsManyLinesAsItSays) {
    const std::string whole = identity_cube(2);
    EXPECT_EQ(faults_of(whole + "0 0 0\n"), Lines{"a.cube:10:1: error: more than the 8 lines of the table"});
    // Cut after any line but the last.
    for (std::size_t end = whole.find('\n') + 1, lines = 0; end < whole.size();
         end = whole.find('\n', end) + 1, ++lines)
        EXPECT_EQ(faults_of(whole.substr(0, end)),
                  Lines{"a.cube:" + std::to_string(lines + 1) + ":1: error: the table ends after " +
                        std::to_string(lines) + " of 8 lines"});
    EXPECT_EQ(faults_of(""), Lines{"a.cube: error: has no LUT_1D_SIZE or LUT_3D_SIZE"});
    EXPECT_EQ(faults_of("0 0 0\n1 1 1\n"),
              Lines{"a.cube:1:1: error: a table begins, but no LUT_1D_SIZE or LUT_3D_SIZE before it says how "
                    "long it is"});
}

TEST(Lut, KeepsToTheSizesOfTheSpecification) {
    const auto size_fault = [](const std::string& dimensions, const std::string& size, const char* limit) {
        EXPECT_EQ(faults_of("LUT_" + dimensions + "D_SIZE " + size + "\n").at(0),
                  "a.cube:1:1: error: LUT_" + dimensions + "D_SIZE '" + size +
                      "' is not a whole number from 2 to " + limit);
    };
    for (const char* size : {"1", "257", "-2", "1e99", "two", ""}) size_fault("3", size, "256");
    for (const char* size : {"1", "65537", "4294967298"}) size_fault("1", size, "65536");
    std::string longest = "LUT_1D_SIZE 65536\n";
    for (int i = 0; i < 65536; ++i) longest += "0 0 1\n";
    EXPECT_EQ(lut_of(longest).values.size(), 3u * 65536u);
}

TEST(Lut, StopsAfterTwentyFaults) {
    std::string text = "LUT_1D_SIZE 100\n";
    for (int i = 0; i < 100; ++i) text += "x\n";
    const Lines faults = faults_of(text);
    ASSERT_EQ(faults.size(), 21u);
    EXPECT_EQ(faults[20], "a.cube:21:1: error: 20 faults so far, the rest of the file is not read");
}

TEST(Lut, OfAFileNamesIt) {
    const test::TemporaryFolder folder;
    const auto read = [&](const std::filesystem::path& path) {
        Diagnostics diagnostics;
        EXPECT_FALSE(read_lut(path, diagnostics).has_value());
        return test::lines_of(diagnostics);
    };
    EXPECT_EQ(read(folder / "a.cube"), Lines{(folder / "a.cube").string() + ": error: no such file"});
    EXPECT_EQ(read(folder.path()), Lines{folder.path().string() + ": error: is not a regular file"});
    test::write_text(folder / "b.cube", "LUT_3D_SIZE 1\n");
    EXPECT_EQ(read(folder / "b.cube"),
              Lines{(folder / "b.cube").string() +
                    ":1:1: error: LUT_3D_SIZE '1' is not a whole number from 2 to 256"});
    test::write_text(folder / "c.cube", identity_cube(3));
    Diagnostics diagnostics;
    const auto lut = read_lut(folder / "c.cube", diagnostics);
    ASSERT_TRUE(lut.has_value());
    EXPECT_EQ(lut->size, 3);
}

}  // namespace
}  // namespace aftershade
