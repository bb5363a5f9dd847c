// PNGs whose samples are equal, and whose colour chunks are not; and the reverse.
#include <gtest/gtest.h>

#include <cmath>

#include "framework/compare/compare_files.h"
#include "framework/image/srgb.h"
#include "tests/compare/pictures.h"
#include "tests/file/png_chunks.h"

namespace aftershade {
namespace {

using test::png_number;

class ComparePng : public testing::Test {
protected:
    void write(const char* name, const Image& image, const std::string& type = "",
               const std::string& data = "") {
        const std::string png = encode_png("", image);
        test::write_text(folder_ / name, type.empty() ? png : test::png_with_chunk(png, type, data));
    }
    Comparison compared(double limit = 1e-6) {
        CompareRules rules;
        rules.fail.limit = limit;
        return compare_files(folder_ / "r.png", folder_ / "t.png", rules);
    }
    test::TemporaryFolder folder_;
    Image light_ = test::picture(16, 16, 3, [](int x, int y, int c) { return test::hashed(x, y, c, 7); });
};

TEST_F(ComparePng, OfEqualSamplesIsNotTheSameInAnotherSpace) {
    write("r.png", light_);
    for (const std::string type : {"cICP", "acTL"}) {
        write("t.png", light_, type,
              type == "cICP" ? std::string{9, 16, 0, 1} : png_number(2) + png_number(0));
        const Comparison comparison = compared();
        EXPECT_EQ(comparison.verdict, Verdict::warning) << type;
        ASSERT_EQ(comparison.warnings.size(), 1u);
        const std::string word = type == "cICP" ? "cICP 9 16 0 1" : "animation";
        EXPECT_NE(comparison.warnings[0].find(word), std::string::npos) << comparison.warnings[0];
    }
    write("t.png", light_, "gAMA", png_number(100000));
    EXPECT_EQ(compared().verdict, Verdict::failure);
    write("t.png", light_, "gAMA", png_number(45455));
    EXPECT_EQ(compared().verdict, Verdict::same);
}

TEST_F(ComparePng, OfEqualLightIsTheSameWhateverEncodesIt) {
    Image encoded = light_, power = light_;
    for (float& value : encoded.floats()) value = float(encode_srgb(double(value)));
    for (float& value : power.floats()) value = std::sqrt(value);
    write("r.png", encoded);
    for (const bool linear : {true, false}) {
        write("t.png", linear ? light_ : power, "gAMA", png_number(linear ? 100000 : 50000));
        // Half a step of 8 bits near black is 12.92 times as much once it is encoded.
        EXPECT_EQ(compared(13 / 255.0).verdict, Verdict::same);
        EXPECT_EQ(compared().notes.size(), 1u);
    }
}

TEST_F(ComparePng, OfOneSpaceThatIsNotSrgbSaysSo) {
    for (const char* name : {"r.png", "t.png"}) write(name, light_, "cICP", {12, 13, 0, 1});
    EXPECT_EQ(compared().verdict, Verdict::same);
    EXPECT_TRUE(compared().notes.empty()) << "a known space, by which FLIP decodes them";
    for (const char* name : {"r.png", "t.png"}) write(name, light_, "cICP", {12, 17, 0, 1});
    EXPECT_EQ(compared().verdict, Verdict::same);
    EXPECT_EQ(compared().notes.size(), 2u) << "FLIP reads both as sRGB";
}

TEST_F(ComparePng, ByAMaskTakesTheMasksNumbersAsTheyAreStored) {
    write("r.png", light_);
    write("t.png", test::constant(16, 16, {0, 0, 0}));
    CompareRules rules;
    // 0.3 of light, which sRGB would encode as 0.58, above the half that a mask covers from.
    write("mask.png", test::constant(16, 16, {0.3f}), "gAMA", png_number(100000));
    rules.areas = {{"mask mask.png", mask_area(folder_ / "mask.png", "", {}), std::nullopt}};
    const Comparison comparison = compare_files(folder_ / "r.png", folder_ / "t.png", rules);
    EXPECT_EQ(comparison.verdict, Verdict::failure) << "nothing is left out";
    ASSERT_EQ(comparison.notes.size(), 1u);
    EXPECT_NE(comparison.notes[0].find("mask.png: its gAMA 1 is not applied"), std::string::npos)
        << comparison.notes[0];
    write("mask.png", test::constant(16, 16, {0.6f}));
    rules.areas = {{"mask mask.png", mask_area(folder_ / "mask.png", "", {}), std::nullopt}};
    EXPECT_EQ(compare_files(folder_ / "r.png", folder_ / "t.png", rules).notes.size(), 0u);
}

TEST_F(ComparePng, OfEqualSamplesIsNotTheSameWherePixelsHaveAnotherShape) {
    write("r.png", light_);
    write("t.png", light_, "pHYs", png_number(1000) + png_number(2000) + '\0');
    const Comparison comparison = compared();
    EXPECT_EQ(comparison.verdict, Verdict::warning);
    ASSERT_EQ(comparison.warnings.size(), 1u);
    EXPECT_EQ(comparison.warnings[0], "another pixel aspect: 1 in the reference, 2 in the test image");
    write("t.png", light_, "pHYs", png_number(2835) + png_number(2835) + '\1');  // a resolution alone
    EXPECT_EQ(compared().verdict, Verdict::same);
}

}  // namespace
}  // namespace aftershade
