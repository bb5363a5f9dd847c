#include "framework/file/png_file.h"

#include "tests/file/image_files.h"
#include "tests/file/png_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using test::png_number;
using test::TemporaryFolder;

TEST(Png, KeepsSamplesOf16Bits) {
    const TemporaryFolder folder;
    for (const int channels : {1, 3, 4}) {
        Image image(37, 21, channels);
        for (std::size_t i = 0; i < image.floats().size(); ++i)
            image.floats()[i] = float((i * 2654435761u) % 65536) / 65535;
        write_png(folder / "a.png", image, {}, {.bits = 16});
        PngColor color;
        const Image read = read_png(folder / "a.png", &color);
        EXPECT_EQ(color.bits, 16);
        EXPECT_TRUE(std::ranges::equal(read.floats(), image.floats())) << channels;
    }
}

TEST(PngFile, KeepsEveryByteForOneThreeAndFourChannels) {
    const TemporaryFolder folder;
    for (const int channels : {1, 3, 4}) {
        Image image(16, 16, channels);
        for (std::size_t i = 0; i < image.floats().size(); ++i) {
            image.floats()[i] = float((i * 37 + i / 256) % 256) / 255.0f;
        }
        write_png(folder / "a.png", image);
        const Image read = read_png(folder / "a.png");
        ASSERT_EQ(read.channels(), channels);
        EXPECT_TRUE(std::ranges::equal(read.floats(), image.floats()));
    }
    EXPECT_EQ(folder.file_count(), 1u);
}

/// pHYs as pixels per unit along x over those along y; nullopt without the chunk.
std::optional<double> stored_density_ratio(const std::string& png) {
    const std::size_t at = png.find("pHYs");
    if (at == std::string::npos) return std::nullopt;
    const auto number = [&](std::size_t from) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::uint8_t(png[from + i]);
        return double(value);
    };
    EXPECT_EQ(png[at + 12], 0) << "the unit is not known";
    EXPECT_LT(at, png.find("IDAT"));
    return number(at + 4) / number(at + 8);
}

TEST(PngFile, StoresThePixelAspectWherePixelsAreNotSquare) {
    const Image image(4, 3, 3);
    EXPECT_EQ(stored_density_ratio(encode_png("a", image)), std::nullopt);
    EXPECT_EQ(encode_png("a", image, {}, {.pixel_aspect = 1}), encode_png("a", image));
    // Pixels twice as wide as high are half as many along x.
    for (const float aspect : {2.0f, 0.5f, 1.4587f, 0.9f, 10.0f}) {
        const std::optional<double> ratio =
            stored_density_ratio(encode_png("a", image, {}, {.pixel_aspect = aspect}));
        ASSERT_TRUE(ratio);
        EXPECT_NEAR(*ratio, 1 / double(aspect), 1e-5 / double(aspect));
    }
    const TemporaryFolder folder;
    write_png(folder / "a.png", image, {}, {.pixel_aspect = 2});
    EXPECT_EQ(read_png(folder / "a.png").width(), 4);
    for (const float odd : {0.0f, -1.0f, std::nanf(""), std::numeric_limits<float>::infinity()})
        EXPECT_EQ(stored_density_ratio(encode_png("a", image, {}, {.pixel_aspect = odd})), std::nullopt)
            << odd;
}

TEST(PngFile, RoundsAndClampsAndWritesNanAsZero) {
    const TemporaryFolder folder;
    const float infinity = std::numeric_limits<float>::infinity();
    const float values[] = {-1, 0.49f / 255, 0.51f / 255, 254.6f / 255,
                            7,  infinity,    -infinity,   std::nanf("")};
    const float expected[] = {0, 0, 1, 255, 255, 255, 0, 0};
    Image image(8, 1, 1);
    std::ranges::copy(values, image.floats().begin());
    write_png(folder / "a.png", image);
    const Image read = read_png(folder / "a.png");
    for (int x = 0; x < 8; ++x) EXPECT_EQ(read.at(x, 0, 0) * 255, expected[x]) << x;
}

TEST(PngFile, IsReadAsOiiotoolReadsIt) {
    if (std::system("command -v oiiotool >/dev/null") != 0) GTEST_SKIP() << "SKIPPED: no oiiotool";
    const TemporaryFolder folder;
    write_png(folder / "a.png", test::pattern_image(31, 17, 3));
    const std::string command =
        "oiiotool '" + (folder / "a.png").string() + "' -o '" + (folder / "a.ppm").string() + "' >/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const Image read = read_png(folder / "a.png");
    std::string expected;
    for (const float value : read.floats()) expected.push_back(static_cast<char>(std::lround(value * 255)));
    // OpenImageIO ends a PPM file with its pixels.
    const std::string bytes = test::read_text(folder / "a.ppm");
    ASSERT_GT(bytes.size(), expected.size());
    EXPECT_TRUE(bytes.ends_with(expected));
}

TEST(PngFile, SaysWhatIsWrongWithAFileThatCannotBeRead) {
    const TemporaryFolder folder;
    const auto message = [&](const fs::path& path) { return test::capture_error([&] { read_png(path); }); };
    EXPECT_EQ(message(folder / "none.png"), (folder / "none.png").string() + ": no such file");
    EXPECT_EQ(message(folder.path()), folder.path().string() + ": is a folder, not a PNG file");
    test::write_text(folder / "empty.png", "");
    EXPECT_EQ(message(folder / "empty.png"), (folder / "empty.png").string() + ": the file is empty");
    test::write_text(folder / "text.png", "not a picture");
    EXPECT_NE(message(folder / "text.png").find("text.png: not a PNG file"), std::string::npos);
    write_png(folder / "good.png", test::pattern_image(64, 64, 3));
    const std::string good = test::read_text(folder / "good.png");
    for (std::size_t length = 1; length < good.size(); length += 7) {
        test::write_text(folder / "cut.png", good.substr(0, length));
        EXPECT_NE(message(folder / "cut.png").find("cut.png: "), std::string::npos) << length;
    }
}

TEST(PngFile, IsRefusedWithAnyBitChanged) {
    const TemporaryFolder folder;
    write_png(folder / "good.png", test::pattern_image(8, 8, 3));
    const std::string good = test::read_text(folder / "good.png");
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string bad = good;
        bad[i] = char(bad[i] ^ (1 << i % 8));
        test::write_text(folder / "bad.png", bad);
        // A chunk whose type lost the bit that makes it critical ends in a file without it, which is refused
        // too.
        EXPECT_NE(test::capture_error([&] { read_png(folder / "bad.png"); }).find("bad.png: "),
                  std::string::npos)
            << i;
    }
    test::write_text(folder / "longer.png", good + "what other programs append");
    EXPECT_NO_THROW(read_png(folder / "longer.png"));
}

TEST(PngFile, IsReadWithSixteenBitsAChannel) {
    const TemporaryFolder folder;
    test::write_text(folder / "a.png", test::wide_png());
    const Image read = read_png(folder / "a.png");
    ASSERT_EQ(read.channels(), 1);
    const float expected[] = {0, 1, 256, 65535};
    for (int x = 0; x < 4; ++x) EXPECT_EQ(read.at(x, 0, 0), expected[x] / 65535.0f) << x;
}

TEST(PngFile, LeavesNothingBehindWhenItCannotBeWritten) {
    const TemporaryFolder folder;
    const Image image = test::pattern_image(4, 4, 3);
    fs::create_directory(folder / "folder.png");
    const auto message = [&](const fs::path& path) {
        return test::error_of(ErrorKind::output, [&] { write_png(path, image); });
    };
    EXPECT_EQ(message(folder / "folder.png"),
              (folder / "folder.png").string() + ": is a folder, a file name is expected");
    EXPECT_EQ(message(folder / "none/a.png"), (folder / "none/a.png").string() + ": there is no folder '" +
                                                  (folder / "none").string() + "' (create it first)");
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(PngFile, CarriesTextWithoutAChangeOfItsPixels) {
    const TemporaryFolder folder;
    const Image image = test::pattern_image(31, 17, 4);
    write_png(folder / "plain.png", image);
    write_png(folder / "text.png", image, {{"aftershade/fingerprint", "0123"}, {"Title", "A test"}});
    // A chunk of the PNG specification: its length, its type, the keyword, a zero and the text.
    const std::string text = test::read_text(folder / "text.png");
    EXPECT_NE(text.find(std::string("\0\0\0\x1b"
                                    "tEXt"
                                    "aftershade/fingerprint\0"
                                    "0123",
                                    35)),
              text.npos);
    EXPECT_NE(text.find(std::string("\0\0\0\x0c"
                                    "tEXt"
                                    "Title\0"
                                    "A test",
                                    20)),
              text.npos);
    EXPECT_EQ(test::read_text(folder / "plain.png").find("tEXt"), text.npos);
    EXPECT_TRUE(
        std::ranges::equal(read_png(folder / "text.png").floats(), read_png(folder / "plain.png").floats()));
}

TEST(PngFile, OfAPaletteIsRefusedWhereAPixelHasAColourThatThePaletteLacks) {
    const TemporaryFolder folder;
    const auto chunk = [](const std::string& type, const std::string& data) {
        const std::string checked = type + data;
        return png_number(std::uint32_t(data.size())) + checked +
               png_number(std::uint32_t(
                   crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size()))));
    };
    const auto write = [&](char last) {
        const std::string rows = std::string("\0\0\1", 3) + last;  // a filter and three pixels
        std::string packed(64, '\0');
        uLongf size = packed.size();
        compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                 uLong(rows.size()));
        test::write_text(folder / "p.png",
                         "\x89PNG\r\n\x1a\n" +
                             chunk("IHDR", png_number(3) + png_number(1) + std::string("\x8\x3\0\0\0", 5)) +
                             chunk("PLTE", std::string("\x10\x20\x30\x40\x50\x60", 6)) +
                             chunk("IDAT", packed.substr(0, size)) + chunk("IEND", ""));
    };
    write(1);
    const Image image = read_png(folder / "p.png");
    EXPECT_EQ(image.at(0, 0, 2), 0x30 / 255.0f);
    EXPECT_EQ(image.at(2, 0, 0), 0x40 / 255.0f);
    write(2);
    EXPECT_NE(test::error_of(ErrorKind::capture, [&] { read_png(folder / "p.png"); }).find("palette"),
              std::string::npos);
}

}  // namespace
}  // namespace aftershade
