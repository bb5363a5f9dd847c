#include "framework/file/picture.h"

#include "framework/file/png_file.h"
#include "framework/image/srgb.h"
#include "tests/file/image_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aftershade {
namespace {

using test::TemporaryFolder;

void write(const std::filesystem::path& path, const Image& image, const std::vector<std::string>& names) {
    std::vector<ExrOutputChannel> channels;
    for (std::size_t c = 0; c < names.size(); ++c)
        channels.push_back({names[c], PixelType::float32, &image, int(c)});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, image.width() - 1, image.height() - 1};
    write_exr(path, channels, options);
}

TEST(Picture, OfAJpegHasItsColours) {
    const std::filesystem::path file =
        std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "tests/fuzz/corpus/jpeg/two_halves.jpg";
    const Image image = read_picture(file, PictureSpace::data);
    ASSERT_EQ(image.width(), 32);
    // As Pillow wrote them, at quality 95.
    const float left[] = {200, 40, 20, 255}, right[] = {20, 60, 180, 255};
    for (int c = 0; c < 4; ++c) {
        EXPECT_NEAR(image.at(4, 8, c), left[c] / 255, 3 / 255.0);
        EXPECT_NEAR(image.at(28, 8, c), right[c] / 255, 3 / 255.0);
    }
    const TemporaryFolder folder;
    test::write_text(folder / "short.jpg", test::read_text(file).substr(0, 500));
    EXPECT_THROW(read_picture(folder / "short.jpg", PictureSpace::data), Error);
}

TEST(Picture, OfAnExrHasWhatTheFileHas) {
    const TemporaryFolder folder;
    const Image image = test::pattern_image(5, 3, 4);
    write(folder / "a.exr", image, {"R", "G", "B", "A"});
    EXPECT_TRUE(
        std::ranges::equal(read_picture(folder / "a.exr", PictureSpace::srgb).floats(), image.floats()));
    write(folder / "b.exr", image, {"R", "B"});
    const Image two = read_picture(folder / "b.exr", PictureSpace::data);
    ASSERT_EQ(two.channels(), 4);
    EXPECT_EQ(two.at(2, 1, 0), image.at(2, 1, 0));
    EXPECT_EQ(two.at(2, 1, 1), 0);
    EXPECT_EQ(two.at(2, 1, 2), image.at(2, 1, 1));
    EXPECT_EQ(two.at(2, 1, 3), 1);
    write(folder / "y.exr", image, {"Y"});
    const Image grey = read_picture(folder / "y.exr", PictureSpace::data);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(grey.at(2, 1, c), image.at(2, 1, 0));
    write(folder / "z.exr", image, {"Z", "A"});
    EXPECT_EQ(
        test::capture_error([&] { read_picture(folder / "z.exr", PictureSpace::data); }),
        (folder / "z.exr").string() + ": the first part has no channel R, G, B or Y; it has 'A' and 'Z'");
}

TEST(Picture, OfAPngIsDecodedAndPremultiplied) {
    const TemporaryFolder folder;
    Image image(2, 1, 4);
    const float values[] = {1, 0.5f, 0.02f, 0.25f, 188 / 255.0f, 0, 1, 1};
    std::ranges::copy(values, image.floats().begin());
    write_png(folder / "a.png", image);
    const Image read = read_picture(folder / "a.png", PictureSpace::srgb);
    const double alpha = 64 / 255.0;
    EXPECT_NEAR(read.at(0, 0, 0), alpha, 1e-7);
    EXPECT_NEAR(read.at(0, 0, 1), alpha * std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 1e-7);
    EXPECT_NEAR(read.at(0, 0, 2), alpha * 5 / 255.0 / 12.92, 1e-7);
    EXPECT_EQ(read.at(0, 0, 3), float(alpha));
    EXPECT_NEAR(read.at(1, 0, 0), 0.502886, 1e-6);
    const Image data = read_picture(folder / "a.png", PictureSpace::data);
    EXPECT_EQ(data.at(0, 0, 1), 128 / 255.0f);
    EXPECT_EQ(data.at(0, 0, 3), 64 / 255.0f);
}

TEST(Picture, OfAGreyPngHasThreeEqualChannels) {
    const TemporaryFolder folder;
    test::write_text(folder / "a.png", test::wide_png());
    const Image read = read_picture(folder / "a.png", PictureSpace::data);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(read.at(2, 0, c), 256 / 65535.0f);
    EXPECT_EQ(read.at(2, 0, 3), 1);
    EXPECT_NE(test::capture_error([&] {
                  read_picture(folder / "none.png", PictureSpace::data);
              }).find("none.png: no such file"),
              std::string::npos);
}

TEST(Srgb, IsUndoneByItsInverse) {
    for (double linear = -0.5; linear < 3; linear += 0.001)
        EXPECT_NEAR(decode_srgb(encode_srgb(linear)), linear, 1e-6) << linear;
}

}  // namespace
}  // namespace aftershade
