#include "framework/image/color_space.h"

#include <gtest/gtest.h>

#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

const Chromaticities kXyz = {1, 0, 0, 1, 0, 0, 1.0f / 3, 1.0f / 3};

void expect_near(const ColorMatrix& matrix, const ColorMatrix& expected, double tolerance) {
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(matrix[i], expected[i], tolerance) << i;
}

/// ITU-R BT.709 to CIE XYZ, as IEC 61966-2-1 prints it to four digits.
TEST(ColorSpace, Rec709ToXyzIsThePublishedMatrix) {
    expect_near(conversion_matrix(kRec709, kXyz),
                {0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505}, 2e-4);
}

/// ITU-R BT.2087: BT.709 to BT.2020, of one white.
TEST(ColorSpace, Rec709ToRec2020IsThePublishedMatrix) {
    expect_near(conversion_matrix(kRec709, *color_space_primaries("rec2020")),
                {0.6274, 0.3293, 0.0433, 0.0691, 0.9195, 0.0114, 0.0164, 0.0880, 0.8956}, 2e-4);
}

/// The AP0 to AP1 matrix of the ACES system (Academy S-2014-004 appendix): one white, no adaptation.
TEST(ColorSpace, Ap0ToAcescgIsThePublishedMatrix) {
    expect_near(conversion_matrix(*color_space_primaries("ap0"), *color_space_primaries("acescg")),
                {1.4514393161, -0.2365107469, -0.2149285693, -0.0765537734, 1.1762296998, -0.0996759264,
                 0.0083161484, -0.0060324498, 0.9977163014},
                2e-5);
}

TEST(ColorSpace, KeepsWhiteWhereWhitesDiffer) {
    const ColorMatrix m = conversion_matrix(*color_space_primaries("acescg"), kRec709);
    for (std::size_t row = 0; row < 3; ++row)
        EXPECT_NEAR(m[row * 3] + m[row * 3 + 1] + m[row * 3 + 2], 1, 1e-9);
}

TEST(ColorSpace, RefusesPrimariesOnOneLine) {
    const Chromaticities line = {0.1f, 0.1f, 0.2f, 0.2f, 0.3f, 0.3f, 0.3127f, 0.329f};
    EXPECT_NE(capture_error([&] { conversion_matrix(line, kRec709); }).find("primaries"), std::string::npos);
}

TEST(ColorSpace, NamesKnownPrimaries) {
    EXPECT_EQ(name_of_primaries(kRec709), "rec709");
    EXPECT_EQ(name_of_primaries(kXyz), "");
    EXPECT_FALSE(color_space_primaries("srgb").has_value());
}

}  // namespace
}  // namespace aftershade::test
