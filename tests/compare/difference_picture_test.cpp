#include "framework/compare/difference_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

using test::constant;
using test::kInfinity;
using test::kNan;
using test::row;

TEST(DifferencePicture, IsReferenceMinusTestTimesTheScale) {
    const Image signed_one = difference_image(row({1, 2}), row({3, 1.5f}), LayerRole::color, {false, 2});
    EXPECT_EQ(signed_one.at(0, 0, 0), -4);
    EXPECT_EQ(signed_one.at(1, 0, 0), 1);
    EXPECT_EQ(difference_image(row({1}), row({3}), LayerRole::color, {true, 2}).at(0, 0, 0), 4);
}

TEST(DifferencePicture, IsNoneOfEqualInfinitiesAndNanOfNan) {
    const Image difference = difference_image(row({kInfinity, -kInfinity, kInfinity, kNan, 1}),
                                              row({kInfinity, -kInfinity, 1, 1, kNan}), LayerRole::depth, {});
    EXPECT_EQ(difference.at(0, 0, 0), 0);
    EXPECT_EQ(difference.at(1, 0, 0), 0);
    EXPECT_EQ(difference.at(2, 0, 0), kInfinity);
    EXPECT_TRUE(std::isnan(difference.at(3, 0, 0)));
    EXPECT_TRUE(std::isnan(difference.at(4, 0, 0)));
}

TEST(DifferencePicture, OfIdsMarksTheOthers) {
    const Image difference =
        difference_image(test::ids({1, 2, 3}), test::ids({1, 200, 3}), LayerRole::id, {});
    EXPECT_EQ(difference.at(0, 0, 0), 0);
    EXPECT_EQ(difference.at(1, 0, 0), 1);
    EXPECT_EQ(difference.at(2, 0, 0), 0);
}

TEST(Magma, RunsFromBlackToPaleYellowAndGrowsBrighter) {
    EXPECT_LT(magma_color(0)[0] + magma_color(0)[1] + magma_color(0)[2], 0.02f);
    EXPECT_NEAR(magma_color(1)[1], 0.991438f, 0.003f) << "matplotlib's last entry";
    EXPECT_NEAR(magma_color(128 / 255.0f)[0], 0.716387f, 0.012f) << "matplotlib's 128th";
    double before = -1;
    for (int i = 0; i <= 100; ++i) {
        const DisplayColor color = magma_color(float(i) / 100);
        const double luma = 0.2126 * double(color[0]) + 0.7152 * double(color[1]) + 0.0722 * double(color[2]);
        EXPECT_GT(luma, before);
        before = luma;
    }
    EXPECT_EQ(magma_color(kNan), magma_color(0));
}

class SideBySide : public testing::Test {
protected:
    static SideBySideRow row_of(const Image& reference, const Image& test, LayerRole role) {
        LayerComparison layer;
        layer.label = "layer";
        layer.role = role;
        for (int c = 0; c < reference.channels(); ++c) layer.channels.push_back(std::to_string(c));
        layer.window = {0, 0, reference.width() - 1, reference.height() - 1};
        compare_layer({reference, test, {}}, {}, layer);
        return side_by_side_row(layer, {reference, test});
    }
    static float at_middle(const Image& picture, int channel) {
        return picture.at(picture.width() / 2, picture.height() / 2, channel);
    }
};

TEST_F(SideBySide, ShowsBothImagesInOneScale) {
    for (const LayerRole role : {LayerRole::color, LayerRole::depth, LayerRole::data}) {
        const int channels = role == LayerRole::color ? 3 : 1;
        const Image dark = constant(8, 8, std::vector<float>(std::size_t(channels), 1.0f));
        const Image bright = constant(8, 8, std::vector<float>(std::size_t(channels), 4.0f));
        const SideBySideRow row = row_of(dark, bright, role);
        EXPECT_NE(at_middle(row.pictures[0], 1), at_middle(row.pictures[1], 1))
            << layer_role_name(role) << ": constants that are each exposed by themselves look alike";
    }
}

TEST_F(SideBySide, ShowsASinglePixelOfALargePicture) {
    const Image reference(2600, 40, 1);
    Image test = reference;
    test.at(1301, 20, 0) = 1;
    const SideBySideRow row = row_of(reference, test, LayerRole::data);
    EXPECT_LE(row.pictures[2].width(), kSideBySideWidth_px);
    float brightest = 0;
    for (const float value : row.pictures[2].floats()) brightest = std::max(brightest, value);
    EXPECT_GT(brightest, 0.9f);
}

TEST_F(SideBySide, DrawsEveryRoleAndKind) {
    const auto filled = [](int channels) {
        return test::picture(6, 5, channels, [](int x, int y, int c) { return test::hashed(x, y, c, 1); });
    };
    for (const std::string& name : layer_role_names())
        for (const int channels : {1, 2, 3, 4, 5}) {
            const SideBySideRow row = row_of(filled(channels), filled(channels), *find_layer_role(name));
            EXPECT_EQ(row.pictures[0].width(), row.pictures[2].width()) << name << " " << channels;
        }
    Image integers(6, 5, 2, ComponentType::uint32);
    for (const std::string& name : layer_role_names()) {
        const SideBySideRow row = row_of(integers, integers, *find_layer_role(name));
        EXPECT_GT(draw_side_by_side({row, row}, "title").height(), 2 * row.pictures[0].height());
    }
}

}  // namespace
}  // namespace aftershade
