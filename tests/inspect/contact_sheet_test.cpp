#include "framework/inspect/contact_sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "framework/image/false_color.h"
#include "tests/not_finite.h"
#include "tests/synthetic_capture.h"

namespace aftershade {
namespace {

using test::kInfinity;
using test::kNan;

/// `image` as the only role of a capture.
Capture capture_of(const std::string& role, Image image) {
    Capture capture;
    capture.header.path = "a.exr";
    capture.header.data_window =
        capture.header.display_window = {0, 0, image.width() - 1, image.height() - 1};
    capture.images[role] = std::move(image);
    return capture;
}

Image filled(int width, int height, int channels, float value) {
    Image image(width, height, channels);
    std::fill(image.floats().begin(), image.floats().end(), value);
    return image;
}

/// Pixels of the first tile that have exactly this colour.
int count_in_first_tile(const Image& sheet, const ContactSheetLayout& layout, const DisplayColor& color) {
    int count = 0;
    for (int y = 0; y < layout.tile_height_px; ++y)
        for (int x = 0; x < layout.tile_width_px; ++x) {
            bool same = true;
            for (int c = 0; c < 3; ++c)
                same &= sheet.at(layout.tile_x(0) + x, layout.tile_y(0) + y, c) == color[std::size_t(c)];
            count += same;
        }
    return count;
}

struct Shape {
    int width, height;
    float pixel_aspect;
    int tile_width, tile_height;
};

TEST(ContactSheet, TilesKeepTheAspectAndStayBelow480Px) {
    for (const Shape& shape :
         {Shape{480, 270, 1, 480, 270}, Shape{960, 540, 1, 480, 270}, Shape{1920, 1080, 1, 480, 270},
          Shape{100, 50, 1, 400, 200}, Shape{500, 1000, 1, 240, 480}, Shape{1, 1, 1, 480, 480},
          Shape{4000, 1, 1, 480, 1}, Shape{480, 480, 2, 480, 240}, Shape{480, 480, 0.5f, 240, 480}}) {
        CaptureHeader header;
        header.data_window = {10, 20, 10 + shape.width - 1, 20 + shape.height - 1};
        header.pixel_aspect = shape.pixel_aspect;
        const ContactSheetLayout layout = contact_sheet_layout(header, 3);
        EXPECT_EQ(layout.tile_width_px, shape.tile_width) << shape.width << " x " << shape.height;
        EXPECT_EQ(layout.tile_height_px, shape.tile_height) << shape.width << " x " << shape.height;
    }
}

TEST(ContactSheet, HoldsEveryRoleWithItsLabelBelowWithoutOverlap) {
    test::SyntheticScene scene;
    scene.sphere = test::SyntheticSphere{20, 15, 9, 2};
    scene.box = test::SyntheticBox{40, 5, 10, 10, 3, 1};
    const Capture capture = test::make_capture(scene);
    const int tiles = int(capture.images.size());
    const ContactSheetLayout layout = contact_sheet_layout(capture.header, tiles);
    const Image sheet = draw_contact_sheet(capture);
    EXPECT_EQ(sheet.width(), layout.width_px);
    EXPECT_EQ(sheet.height(), layout.height_px);
    EXPECT_EQ(sheet.channels(), 3);
    EXPECT_EQ(layout.columns * layout.rows, tiles) << "12 roles fill a rectangle";
    for (int tile = 0; tile < tiles; ++tile) {
        EXPECT_LE(layout.tile_x(tile) + layout.tile_width_px, sheet.width());
        EXPECT_LT(layout.tile_y(tile) + layout.tile_height_px, sheet.height());
        int bright = 0;  // the role's name, in white
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 100; ++x)
                bright += sheet.at(layout.tile_x(tile) + x,
                                   layout.tile_y(tile) + layout.tile_height_px + 8 + y, 1) == 1;
        EXPECT_GT(bright, 50) << tile;
    }
    for (const float value : sheet.floats()) ASSERT_TRUE(value >= 0 && value <= 1) << value;
}

TEST(ContactSheet, MarksAPixelOnlyWhereItIsFaulty) {
    const DisplayColor nan = pixel_fault_color(PixelFault::nan);
    Image image = filled(48, 27, 4, 0.5f);
    const Capture sound = capture_of("color", image);
    const ContactSheetLayout layout = contact_sheet_layout(sound.header, 1);
    EXPECT_EQ(count_in_first_tile(draw_contact_sheet(sound), layout, nan), 0);

    image.at(20, 10, 1) = kNan;
    const Image sheet = draw_contact_sheet(capture_of("color", image));
    for (int y = 100; y < 110; ++y)
        for (int x = 200; x < 210; ++x)  // enlarged ten times
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(sheet.at(layout.tile_x(0) + x, layout.tile_y(0) + y, c), nan[std::size_t(c)]);
    EXPECT_EQ(count_in_first_tile(sheet, layout, nan), 12 * 12) << "and a rim of one pixel";
}

TEST(ContactSheet, ShowsOneFaultyPixelOfALargeImage) {
    for (const auto& [fault, value] :
         {std::pair{PixelFault::nan, kNan}, std::pair{PixelFault::infinite, kInfinity},
          std::pair{PixelFault::negative, -1.0f}}) {
        Image image = filled(4000, 2000, 3, 0.5f);
        image.at(1234, 987, 2) = value;
        const Capture capture = capture_of("irradiance", std::move(image));
        const ContactSheetLayout layout = contact_sheet_layout(capture.header, 1);
        EXPECT_GE(count_in_first_tile(draw_contact_sheet(capture), layout, pixel_fault_color(fault)), 1)
            << pixel_fault_name(fault);
    }
}

TEST(ContactSheet, SaysWhyARoleCannotBeShown) {
    const Capture capture = capture_of("color", filled(64, 36, 4, 0.5f));
    const std::string message = std::string(300, 'x') + " \xff\n";  // any length, any bytes
    const Image sheet = draw_contact_sheet(capture, {{"depth", message}});
    EXPECT_EQ(sheet.width(), contact_sheet_layout(capture.header, 2).width_px);
}

TEST(FalseColor, ShowsColorsAsTheyAreUpToOneExposure) {
    Image image(2, 1, 3);
    const float linear[] = {0.18f, 0.09f, 0.045f, 0.18f, 0.09f, 0.045f};
    std::copy(std::begin(linear), std::end(linear), image.floats().begin());
    const FalseColor picture("color", image, {});
    // Both pixels have one luminance, so that becomes 0.18; stops are rounded to tenths.
    const double luminance = 0.2126 * 0.18 + 0.7152 * 0.09 + 0.0722 * 0.045;
    const double exposure = std::exp2(std::round(std::log2(0.18 / luminance) * 10) / 10);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(picture.color(0, 0)[c], 1.055 * std::pow(double(linear[c]) * exposure, 1 / 2.4) - 0.055,
                    1e-5);
    EXPECT_EQ(picture.label()[0], "up to 0.18");
}

TEST(FalseColor, ShowsColorsOfOtherPrimariesInThoseOfTheScreen) {
    Image image = filled(1, 1, 3, 0.5f);
    const FalseColor picture("color", image, *color_space_primaries("acescg"));
    const DisplayColor white = picture.color(0, 0);
    EXPECT_NEAR(white[0], white[1], 1e-3);
    EXPECT_NEAR(white[1], white[2], 1e-3);
    image.at(0, 0, 1) = 0;
    EXPECT_EQ(FalseColor("color", image, *color_space_primaries("acescg")).fault(0, 0), PixelFault::none)
        << "what lies beyond the screen's colours is no fault of the file";
}

TEST(FalseColor, RunsFromBrightNearToDarkFarAndMarksNothingHit) {
    Image depth(4, 1, 1);
    const float metres[] = {1, 10, 100, kInfinity};
    std::copy(std::begin(metres), std::end(metres), depth.floats().begin());
    const FalseColor picture("depth", depth, {});
    const auto green = [&](int x) { return picture.color(x, 0)[1]; };
    EXPECT_GT(green(0), green(1));
    EXPECT_GT(green(1), green(2));
    EXPECT_EQ(picture.color(3, 0), kNothingHitColor);
    EXPECT_EQ(picture.fault(3, 0), PixelFault::none);
    EXPECT_EQ(picture.label()[0], "1 to 100 m");
    EXPECT_EQ(picture.label()[1], "nothing hit: 25 %");
}

TEST(FalseColor, TellsDirectionsApartByHueAndStandsStillInBlack) {
    Image velocity(5, 1, 2);
    const float vectors[] = {10, 0, -10, 0, 0, 10, 0, -10, 0, 0};
    std::copy(std::begin(vectors), std::end(vectors), velocity.floats().begin());
    const FalseColor picture("velocity", velocity, {});
    EXPECT_EQ(picture.label()[0], "up to 10 px a frame");
    EXPECT_EQ(picture.label()[1], "rim of the wheel: 10 px");
    const DisplayColor right = picture.color(0, 0), left = picture.color(1, 0);
    EXPECT_GT(right[0], 0.95f);
    EXPECT_LT(right[2], 0.05f) << "right is red";
    EXPECT_LT(left[0], 0.05f) << "left is its complement";
    EXPECT_NE(picture.color(2, 0), picture.color(3, 0));
    EXPECT_EQ(picture.color(4, 0), (DisplayColor{0, 0, 0}));
    EXPECT_EQ(picture.fault(1, 0), PixelFault::none) << "motion may be negative";
}

TEST(FalseColor, GivesNeighbouringIdsColorsThatDiffer) {
    Image ids(257, 1, 1, ComponentType::uint32);
    for (int i = 0; i < 257; ++i) ids.uint_at(i, 0, 0) = std::uint32_t(i);
    const FalseColor picture("object_id", ids, {});
    EXPECT_EQ(picture.color(0, 0), (DisplayColor{0, 0, 0}));
    for (int i = 1; i < 257; ++i) {
        const DisplayColor one = picture.color(i, 0), before = picture.color(i - 1, 0);
        const float difference =
            std::abs(one[0] - before[0]) + std::abs(one[1] - before[1]) + std::abs(one[2] - before[2]);
        EXPECT_GT(difference, 0.3f) << i;
    }
    EXPECT_TRUE(picture.label()[0].starts_with("256 ids: 1 2 3")) << picture.label()[0];
}

TEST(FalseColor, ShowsDataWithoutASignFromDarkToBright) {
    Image radii(3, 1, 1);
    radii.at(1, 0, 0) = 8;
    radii.at(2, 0, 0) = std::numeric_limits<float>::infinity();
    const FalseColor picture(std::string(kDataRole), radii, {});
    EXPECT_EQ(picture.color(0, 0), ramp_color(0));
    EXPECT_EQ(picture.color(1, 0), ramp_color(1));
    EXPECT_EQ(picture.color(2, 0), pixel_fault_color(PixelFault::infinite));
    EXPECT_EQ(picture.label()[0], "0 to 8");
}

TEST(FalseColor, CountsFaultsByTheRolesContract) {
    Image image = filled(3, 1, 1, 0.5f);
    image.at(0, 0, 0) = -1;
    image.at(1, 0, 0) = kInfinity;
    image.at(2, 0, 0) = kNan;
    const auto counts = [&](const std::string& role) {
        const FalseColor picture(role, image, {});
        return std::array{picture.fault_count(PixelFault::negative),
                          picture.fault_count(PixelFault::infinite), picture.fault_count(PixelFault::nan)};
    };
    using Counts = std::array<std::uint64_t, 3>;
    EXPECT_EQ(counts("mask"), (Counts{1, 1, 1}));
    EXPECT_EQ(counts("depth"), (Counts{1, 0, 1})) << "+inf is nothing hit";
    EXPECT_EQ(counts("aov:height"), (Counts{0, 1, 1})) << "what passes through may be negative";
}

}  // namespace
}  // namespace aftershade
