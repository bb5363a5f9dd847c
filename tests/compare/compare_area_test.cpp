#include "framework/compare/compare_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/compare/compare_files.h"
#include "framework/compare/comparison_report.h"
#include "framework/compare/difference_picture.h"
#include "tests/compare/pictures.h"

namespace aftershade::test {
namespace {

/// 24 x 16 px; the test image differs by 0.5 in a block of 4 x 3 px from (10, 6).
class CompareAreas : public testing::Test {
protected:
    static constexpr int kWidth = 24, kHeight = 16;
    CompareAreas() {
        write_rgb(folder_ / "r.exr", base());
        write_rgb(folder_ / "t.exr", with_block(0.5f));
        rules_.threads = 1;
    }
    static Image base() {
        return picture(kWidth, kHeight, 3, [](int x, int y, int c) { return 0.4f * hashed(x, y, c, 4); });
    }
    static Image with_block(float more) {
        Image image = base();
        for (int y = 6; y < 9; ++y)
            for (int x = 10; x < 14; ++x)
                for (int c = 0; c < 3; ++c) image.at(x, y, c) += more;
        return image;
    }
    void leave_out(AreaShape shape) { rules_.areas.push_back({"it", std::move(shape), std::nullopt}); }
    Comparison compare(const std::string& test = "t.exr") {
        return compare_files(folder_ / "r.exr", folder_ / test, rules_);
    }

    TemporaryFolder folder_;
    CompareRules rules_;
};

TEST_F(CompareAreas, LeavesOutRectanglesOfTheDisplayWindow) {
    EXPECT_EQ(compare().verdict, Verdict::failure);
    leave_out(rectangle_area(10, 6, 4, 3));
    const Comparison comparison = compare();
    EXPECT_EQ(comparison.verdict, Verdict::same);
    EXPECT_EQ(comparison.layers[0].differences.left_out, 12u);
    EXPECT_EQ(comparison.layers[0].differences.pixels, 24u * 16 - 12);
    EXPECT_TRUE(comparison.layers[0].differences.bits_equal);
    rules_.areas[0].shape = rectangle_area(10, 6, 4, 2);
    EXPECT_EQ(compare().layers[0].differences.failing.count, 4u) << "a row too few";
    // The same pixels in a file whose windows begin elsewhere.
    const Window data{103, -20, 126, -5}, display{100, -24, 140, 0};
    write_exr_file(folder_ / "r.exr", {{{"R", "G", "B"}, base()}}, data, display);
    write_exr_file(folder_ / "t.exr", {{{"R", "G", "B"}, with_block(0.5f)}}, data, display);
    rules_.areas[0].shape = rectangle_area(13, 10, 4, 3);
    EXPECT_EQ(compare().verdict, Verdict::same);
}

TEST_F(CompareAreas, AreMasksFromPngsAndChannels) {
    const Image mask = picture(kWidth, kHeight, 3, [](int x, int y, int c) {
        return c == 1 && x >= 10 && x < 14 && y >= 6 && y < 9 ? 1.0f : 0.2f;
    });
    write_png(folder_ / "mask.png", mask);
    write_rgb(folder_ / "mask.exr", mask);
    for (const auto& [file, channel] : {std::pair{"mask.png", ""}, std::pair{"mask.exr", "G"}}) {
        rules_.areas.clear();
        leave_out(mask_area(folder_ / file, channel, {}));
        EXPECT_EQ(compare().verdict, Verdict::same) << file;
        EXPECT_EQ(compare().layers[0].differences.left_out, 12u) << file;
    }
    const auto message = [&](const char* file, const char* channel) {
        try {
            mask_area(folder_ / file, channel, {});
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(message("mask.exr", "").find("name one of"), std::string::npos);
    EXPECT_NE(message("mask.exr", "g").find("has no channel 'g'"), std::string::npos);
    EXPECT_NE(message("mask.png", "G").find("have no names"), std::string::npos);
    EXPECT_NE(message("none.png", "").find("No such file"), std::string::npos);
}

TEST_F(CompareAreas, ThatAreNowhereOrEverywhereAreFaults) {
    leave_out(rectangle_area(24, 0, 5, 5));
    Comparison comparison = compare("r.exr");
    EXPECT_EQ(comparison.verdict, Verdict::different_size) << "although both are one file";
    ASSERT_EQ(comparison.faults.size(), 1u);
    EXPECT_NE(comparison.faults[0].find("outside of the picture, which has 24 x 16 px"), std::string::npos);
    rules_.areas[0].shape = rectangle_area(-3, -3, 100, 100);
    comparison = compare("r.exr");
    EXPECT_EQ(comparison.verdict, Verdict::different_size) << "never a pass";
    EXPECT_NE(comparison.faults.at(0).find("every pixel is left out"), std::string::npos);
    EXPECT_NE(text_of(comparison, rules_).find("384 of 384 pixels (100 %)"), std::string::npos)
        << text_of(comparison, rules_);
    EXPECT_EQ(json_of(comparison, rules_)["layers"][0]["left_out_percent"], 100);
    write_png(folder_ / "small.png", constant(8, 8, {1}));
    rules_.areas[0].shape = mask_area(folder_ / "small.png", "", {});
    EXPECT_EQ(compare("r.exr").verdict, Verdict::different_size) << "a mask of another size";
}

TEST_F(CompareAreas, HaveLimitsOfTheirOwn) {
    Levels wide;
    wide.fail.limit = 0.6;
    rules_.areas.push_back({"block", rectangle_area(10, 6, 4, 3), wide});
    EXPECT_EQ(compare().verdict, Verdict::same);
    write_rgb(folder_ / "t.exr", with_block(0.7f));
    const LayerComparison layer = compare().layers.at(0);
    EXPECT_EQ(layer.verdict, Verdict::failure);
    EXPECT_NE(layer.reasons.at(0).find("in the area block: 12 pixels (100 %) differ by more than fail 0.6"),
              std::string::npos)
        << layer.reasons.at(0);
    rules_.areas[0].levels->fail.percent = 99;
    EXPECT_EQ(compare().verdict, Verdict::failure) << "percent of the area's pixels";
    rules_.areas[0].levels->fail.percent = 100;
    EXPECT_LE(compare().verdict, Verdict::warning);
    // And the rest keeps the layer's: one pixel beside the block.
    Image image = with_block(0.5f);
    image.at(9, 6, 0) += 0.1f;
    write_rgb(folder_ / "t.exr", image);
    EXPECT_EQ(compare().layers.at(0).differences.by_area.at(0).failing.count, 1u);
    EXPECT_EQ(compare().verdict, Verdict::failure);
    // What is left out is left out whatever else holds there.
    leave_out(rectangle_area(9, 6, 5, 3));
    EXPECT_EQ(compare().verdict, Verdict::same);
}

TEST_F(CompareAreas, AreInNoMeasureOfHowAPictureLooks) {
    Image one = with_block(0.5f), other = with_block(7);
    for (Image* image : {&one, &other}) image->at(2, 2, 1) += 0.3f;
    write_rgb(folder_ / "one.exr", one);
    write_rgb(folder_ / "other.exr", other);
    leave_out(rectangle_area(10, 6, 4, 3));
    const LayerComparison a = compare("one.exr").layers.at(0), b = compare("other.exr").layers.at(0);
    EXPECT_EQ(a.hdr_flip->mean, b.hdr_flip->mean) << "whatever is in there";
    EXPECT_EQ(*a.ssim, *b.ssim);
    EXPECT_GT(a.hdr_flip->mean, 0);
    EXPECT_LE(a.hdr_flip->max_x, 5) << "beside the pixel that differs, not in the block";
    EXPECT_LT(*a.ssim, 1);
    EXPECT_EQ(a.differences.failing.count, 1u);
    // 14 x 6 pixels have a whole window; none of them is left.
    rules_.areas[0].shape = rectangle_area(5, 5, 14, 6);
    rules_.fail.limit = 1;
    rules_.fail_ssim = 0.1;
    const LayerComparison none = compare("one.exr").layers.at(0);
    EXPECT_FALSE(none.ssim);
    EXPECT_EQ(none.verdict, Verdict::failure) << "no SSIM is no pass";
}

TEST_F(CompareAreas, LeaveLayersTheirOwnLimits) {
    const auto write = [&](const char* name, float color, float depth) {
        write_exr_file(folder_ / name, {{{"R", "G", "B"}, constant(8, 8, {color, color, color})},
                                        {{"Z"}, constant(8, 8, {depth})}});
    };
    write("r.exr", 0.5f, 10);
    write("t.exr", 0.55f, 10.05f);
    rules_.fail.limit = 0.1;
    EXPECT_EQ(compare().verdict, Verdict::same);
    rules_.layers["Z"].fail.limit = 0.001;
    const Comparison comparison = compare();
    EXPECT_EQ(comparison.layers.at(0).verdict, Verdict::same);
    EXPECT_EQ(comparison.layers.at(1).verdict, Verdict::failure);
    EXPECT_TRUE(comparison.unknown_layers.empty());
    rules_.layers["depth"] = {};
    EXPECT_EQ(compare().unknown_layers, std::vector<std::string>{"depth"});
}

TEST_F(CompareAreas, AreBlackInTheDifferenceAndBlueBesideIt) {
    leave_out(rectangle_area(10, 6, 2, 3));
    ComparisonPictures pictures({true, 1}, true, true, true);
    std::vector<SideBySideRow> rows;
    compare_files(folder_ / "r.exr", folder_ / "t.exr", rules_,
                  [&](const LayerComparison& layer, LayerImages& images) {
                      pictures.add(layer, images);
                      rows.push_back(side_by_side_row(layer, images));
                  });
    pictures.write_difference(folder_ / "d.exr");
    const Image difference = ExrFile(folder_ / "d.exr").read_floats(0, std::vector<std::string>{"R"});
    EXPECT_EQ(difference.at(10, 7, 0), 0);
    EXPECT_NEAR(difference.at(12, 7, 0), 0.5f, 1e-6f);
    EXPECT_NE(rows.at(0).captions[2].find("blue is left out"), std::string::npos);
    const Image& shown = rows[0].pictures[2];
    const int scale = shown.width() / kWidth;
    EXPECT_GT(shown.at(10 * scale, 7 * scale, 2), shown.at(10 * scale, 7 * scale, 0) + 0.3f);
}

}  // namespace
}  // namespace aftershade::test
