// Linear colours of other primaries than Rec. 709's.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "framework/compare/difference_picture.h"
#include "framework/compare/perceptual.h"
#include "framework/file/png_file.h"
#include "framework/image/color_space.h"
#include "framework/image/srgb.h"
#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

constexpr int kSide_px = 24;

/// Light as ACEScg has it, by the matrix of the ACES project's CTL (Rec. 709 to AP1, Bradford).
Image in_acescg(const Image& rec709) {
    constexpr std::array<std::array<float, 3>, 3> kMatrix = {{{0.613097f, 0.339523f, 0.047379f},
                                                              {0.070194f, 0.916354f, 0.013452f},
                                                              {0.020616f, 0.109570f, 0.869815f}}};
    return test::picture(kSide_px, kSide_px, 3, [&](int x, int y, int c) {
        const std::array<float, 3>& row = kMatrix[std::size_t(c)];
        return row[0] * rec709.at(x, y, 0) + row[1] * rec709.at(x, y, 1) + row[2] * rec709.at(x, y, 2);
    });
}

class WideColors : public testing::Test {
protected:
    WideColors() {
        for (const int seed : {1, 2})
            pictures_.push_back(test::picture(kSide_px, kSide_px, 3, [&](int x, int y, int c) {
                return 0.02f + 0.9f * test::hashed(x / 4, y / 4, c, seed);
            }));
    }
    void write(const char* name, const Image& image, const char* space) {
        std::vector<ExrOutputChannel> channels;
        for (int c = 0; c < 3; ++c)
            channels.push_back({std::string(1, "RGB"[c]), PixelType::float32, &image, c});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, kSide_px - 1, kSide_px - 1};
        const Chromaticities primaries = color_space_primaries(space).value();
        options.attributes["chromaticities"] = std::vector<float>(primaries.begin(), primaries.end());
        write_exr(folder_ / name, channels, options);
    }
    /// The layer of r.exr and t.exr; `row_` gets their pictures.
    LayerComparison compared(FlipChoice choice = FlipChoice::both) {
        CompareRules rules;
        rules.flip_choice = choice;
        return compare_files(folder_ / "r.exr", folder_ / "t.exr", rules,
                             [&](const LayerComparison& layer, LayerImages& images) {
                                 row_ = side_by_side_row(layer, images);
                             })
            .layers.at(0);
    }
    std::vector<Image> pictures_;
    SideBySideRow row_;
    test::TemporaryFolder folder_;
};

TEST_F(WideColors, HaveTheFlipAndSsimAndPicturesOfTheSameLightInRec709) {
    write("r.exr", pictures_[0], "rec709");
    write("t.exr", pictures_[1], "rec709");
    const LayerComparison narrow = compared();
    const SideBySideRow pictures = row_;
    write("r.exr", in_acescg(pictures_[0]), "acescg");
    write("t.exr", in_acescg(pictures_[1]), "acescg");
    const LayerComparison wide = compared();
    EXPECT_GT(narrow.ldr_flip->mean, 0.1);
    EXPECT_NEAR(wide.ldr_flip->mean, narrow.ldr_flip->mean, 1e-4);
    EXPECT_NEAR(wide.hdr_flip->mean, narrow.hdr_flip->mean, 1e-4);
    EXPECT_NEAR(*wide.ssim, *narrow.ssim, 1e-4);
    for (std::size_t side = 0; side < 2; ++side) {
        const std::span<const float> expected = pictures.pictures[side].floats();
        const std::span<const float> shown = row_.pictures[side].floats();
        ASSERT_EQ(shown.size(), expected.size());
        for (std::size_t i = 0; i < shown.size(); ++i) ASSERT_NEAR(shown[i], expected[i], 2e-3) << i;
    }
}

TEST_F(WideColors, AreTheSameLightAsOtherNumbersInAnotherSpace) {
    write("r.exr", pictures_[0], "rec709");
    write("t.exr", in_acescg(pictures_[0]), "acescg");
    const LayerComparison same = compared();
    EXPECT_FALSE(same.differences.bits_equal);
    EXPECT_LT(same.ldr_flip->mean, 1e-3);
    EXPECT_LT(same.hdr_flip->mean, 1e-3);
    EXPECT_GT(*same.ssim, 0.9999);
}

TEST_F(WideColors, AreOtherLightAsTheSameNumbersInAnotherSpace) {
    write("r.exr", pictures_[0], "rec709");
    write("t.exr", pictures_[0], "acescg");
    const LayerComparison other = compared();
    EXPECT_TRUE(other.differences.bits_equal);
    EXPECT_GT(other.ldr_flip->mean, 0.02);
    EXPECT_GT(other.hdr_flip->mean, 0.02);
    EXPECT_LT(*other.ssim, 0.999);
    write("r.exr", pictures_[0], "acescg");
    EXPECT_EQ(compared().hdr_flip->mean, 0);
}

/// By the curves of ST 2084 and BT.2100, written again.
double pq_of(double cd_m2) {
    const double m1 = 0.1593017578125, y = std::pow(cd_m2 / 10000, m1);
    return std::pow((0.8359375 + 18.8515625 * y) / (1 + 18.6875 * y), 78.84375);
}

TEST_F(WideColors, OfAPngOfPqAreComparedAsTheirLight) {
    const ColorEncoding pq{kRec709, ColorEncoding::Curve::pq, 1};
    const auto encoded = [](const Image& light) {
        return test::picture(kSide_px, kSide_px, 3, [&](int x, int y, int c) {
            return float(pq_of(203 * double(light.at(x, y, c))));
        });
    };
    write("r.exr", pictures_[0], "rec709");
    write("t.exr", pictures_[1], "rec709");
    const LayerComparison expected = compared(FlipChoice::automatic);
    write_png(folder_ / "r.png", encoded(pictures_[0]), {}, {pq, 1, 16});
    write_png(folder_ / "t.png", encoded(pictures_[1]), {}, {pq, 1, 16});
    const LayerComparison layer = compare_files(folder_ / "r.png", folder_ / "t.png", {}).layers.at(0);
    EXPECT_FALSE(layer.ldr_flip);
    EXPECT_NEAR(layer.hdr_flip->mean, expected.hdr_flip->mean, 2e-3);
    EXPECT_NEAR(*layer.ssim, *expected.ssim, 2e-3);
}

TEST_F(WideColors, OfAPngOfAnotherDisplayAreTheSameLight) {
    const ColorEncoding broadcast{kRec709, ColorEncoding::Curve::gamma, 2.4};
    const auto power = [&](double gamma) {
        return test::picture(kSide_px, kSide_px, 3, [&](int x, int y, int c) {
            return std::pow(pictures_[0].at(x, y, c), float(1 / gamma));
        });
    };
    const Image srgb = test::picture(kSide_px, kSide_px, 3, [&](int x, int y, int c) {
        return float(encode_srgb(double(pictures_[0].at(x, y, c))));
    });
    write_png(folder_ / "r.png", srgb, {}, {kSrgbDisplay, 1, 16});
    write_png(folder_ / "t.png", power(2.4), {}, {broadcast, 1, 16});
    EXPECT_LT(compare_files(folder_ / "r.png", folder_ / "t.png", {}).layers.at(0).ldr_flip->mean, 1e-3);
}

TEST_F(WideColors, KeepPixelsThatAreNotFinite) {
    Image broken = pictures_[0];
    broken.at(5, 7, 1) = std::numeric_limits<float>::infinity();
    const LayerImages images = {broken, pictures_[0], {}, *color_space_primaries("acescg"), kRec709};
    const LayerImages converted = in_rec709(images, LayerRole::color).value();
    for (int c = 0; c < 3; ++c) EXPECT_EQ(converted.reference.at(5, 7, c), broken.at(5, 7, c)) << c;
    EXPECT_NE(converted.reference.at(0, 0, 0), broken.at(0, 0, 0));
    EXPECT_EQ(converted.test.at(5, 7, 1), pictures_[0].at(5, 7, 1));
}

}  // namespace
}  // namespace aftershade
