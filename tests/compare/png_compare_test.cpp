// PNGs whose samples are equal, and whose colour chunks are not; and the reverse.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>

#include "framework/compare/compare_files.h"
#include "framework/image/srgb.h"
#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

std::string number(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

class ComparePng : public testing::Test {
protected:
    void write(const char* name, const Image& image, const std::string& type = "", const std::string& data = "") {
        std::string png = encode_png("", image);
        const std::string checked = type + data;
        const auto sum = std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size())));
        constexpr std::size_t kBehindHead = 8 + 25;
        if (!type.empty()) png.insert(kBehindHead, number(std::uint32_t(data.size())) + checked + number(sum));
        test::write_text(folder_ / name, png);
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
        write("t.png", light_, type, type == "cICP" ? std::string{9, 16, 0, 1} : number(2) + number(0));
        const Comparison comparison = compared();
        EXPECT_EQ(comparison.verdict, Verdict::warning) << type;
        ASSERT_EQ(comparison.warnings.size(), 1u);
        const std::string word = type == "cICP" ? "cICP 9 16 0 1" : "animation";
        EXPECT_NE(comparison.warnings[0].find(word), std::string::npos) << comparison.warnings[0];
    }
    write("t.png", light_, "gAMA", number(100000));
    EXPECT_EQ(compared().verdict, Verdict::failure);
    write("t.png", light_, "gAMA", number(45455));
    EXPECT_EQ(compared().verdict, Verdict::same);
}

TEST_F(ComparePng, OfEqualLightIsTheSameWhateverEncodesIt) {
    Image encoded = light_, power = light_;
    for (float& value : encoded.floats()) value = float(encode_srgb(double(value)));
    for (float& value : power.floats()) value = std::sqrt(value);
    write("r.png", encoded);
    for (const bool linear : {true, false}) {
        write("t.png", linear ? light_ : power, "gAMA", number(linear ? 100000 : 50000));
        // Half a step of 8 bits near black is 12.92 times as much once it is encoded.
        EXPECT_EQ(compared(13 / 255.0).verdict, Verdict::same);
        EXPECT_EQ(compared().notes.size(), 1u);
    }
}

TEST_F(ComparePng, OfOneSpaceThatIsNotSrgbSaysSo) {
    for (const char* name : {"r.png", "t.png"}) write(name, light_, "cICP", {12, 13, 0, 1});
    EXPECT_EQ(compared().verdict, Verdict::same);
    EXPECT_EQ(compared().notes.size(), 2u) << "FLIP reads both as sRGB";
}

}  // namespace
}  // namespace aftershade
