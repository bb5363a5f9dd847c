#include "framework/inspect/contact_sheet.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace aftershade {
namespace {

Image filled(int width, int height, const std::vector<float>& pixel) {
    Image image(width, height, int(pixel.size()));
    for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = pixel[i % pixel.size()];
    return image;
}

void expect_cell(const FrameSheet& sheet, int index, const std::vector<float>& color) {
    for (int y = 0; y < sheet.tile_height_px(); ++y)
        for (int x = 0; x < sheet.tile_width_px(); ++x)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(sheet.picture().at(sheet.cell_x(index) + x, sheet.cell_y(index) + y, c),
                            color[std::size_t(c)], 1e-5f)
                    << index << ": " << x << ", " << y;
}

TEST(FrameSheet, HasAThumbnailOfEachFrameInReadingOrder) {
    FrameSheet sheet("out_####.exr", 5, 3, 480, 270);
    EXPECT_EQ(sheet.tile_width_px(), 240);
    EXPECT_EQ(sheet.tile_height_px(), 135);
    for (int frame = 1; frame <= 5; ++frame)
        sheet.add(frame, filled(480, 270, {0.1f * float(frame), 0.5f, 0.25f}));
    for (int i = 0; i < 5; ++i) expect_cell(sheet, i, {0.1f * float(i + 1), 0.5f, 0.25f});
    EXPECT_EQ(sheet.cell_y(0), sheet.cell_y(2));
    EXPECT_GT(sheet.cell_y(3), sheet.cell_y(2));
    EXPECT_EQ(sheet.cell_x(3), sheet.cell_x(0));
}

TEST(FrameSheet, AThumbnailPixelIsTheMeanOfItsPixels) {
    Image stripes(480, 270, 3);
    for (int y = 0; y < 270; ++y)
        for (int x = 1; x < 480; x += 2)
            for (int c = 0; c < 3; ++c) stripes.at(x, y, c) = 1;
    FrameSheet sheet("a", 1, 0, 480, 270);
    sheet.add(1, stripes);
    expect_cell(sheet, 0, {0.5f, 0.5f, 0.5f});
}

TEST(FrameSheet, ShowsTransparentPicturesOverBlack) {
    FrameSheet sheet("a", 1, 0, 240, 240);
    sheet.add(1, filled(240, 240, {0.8f, 0.4f, 2.0f, 0.25f}));
    expect_cell(sheet, 0, {0.2f, 0.1f, 0.25f});
}

TEST(FrameSheet, ManyFramesAreSmallerAndAboutEightByFive) {
    const FrameSheet sheet("a", 1000, 0, 1920, 1080);
    EXPECT_EQ(sheet.tile_width_px(), 120);
    EXPECT_NEAR(double(sheet.picture().width()) / sheet.picture().height(), 1.6, 0.15);
}

TEST(FrameSheet, AFrameOfAnotherShapeIsFittedIntoItsCell) {
    FrameSheet sheet("a", 2, 2, 480, 270);
    sheet.add(1, filled(480, 270, {1, 1, 1}));
    sheet.add(2, filled(270, 270, {1, 1, 1}));
    const int middle_y = sheet.cell_y(1) + sheet.tile_height_px() / 2;
    EXPECT_EQ(sheet.picture().at(sheet.cell_x(1) + sheet.tile_width_px() / 2, middle_y, 0), 1.0f);
    EXPECT_LT(sheet.picture().at(sheet.cell_x(1) + 2, middle_y, 0), 0.2f) << "paper beside it";
}

}  // namespace
}  // namespace aftershade
