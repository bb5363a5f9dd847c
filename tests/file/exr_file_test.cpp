#include "framework/file/exr_file.h"

#include "tests/file/image_files.h"
#include "tests/not_finite.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using test::capture_error;
using test::kInfinity;
using test::pattern;
using test::pattern_image;
using test::TemporaryFolder;

const char* const kCompressions[] = {"none",  "rle", "zips", "zip",  "piz",
                                     "pxr24", "b44", "b44a", "dwaa", "dwab"};

ExrWriteOptions options_for(const Image& image, const std::string& compression = "zip") {
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, image.width() - 1, image.height() - 1};
    options.compression = compression;
    return options;
}

void write_one(const fs::path& path, const std::string& name, PixelType type, const Image& image,
               const std::string& compression = "zip") {
    const ExrOutputChannel channel{name, type, &image, 0};
    write_exr(path, {&channel, 1}, options_for(image, compression));
}

Image read_floats(const fs::path& path, const std::vector<std::string>& names, int part = 0) {
    return ExrFile(path).read_floats(part, names);
}

Image read_uints(const fs::path& path, const std::vector<std::string>& names) {
    return ExrFile(path).read_uints(0, names);
}

class EveryCompression : public testing::TestWithParam<const char*> {
protected:
    std::string compression() const { return GetParam(); }
    bool is_b44() const { return compression().starts_with("b44"); }
    TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(ExrFile, EveryCompression, testing::ValuesIn(kCompressions),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(EveryCompression, KeepsEveryHalfBitPattern) {
    if (is_b44()) return;  // packs half channels with loss; KeepsSmoothHalfColorWithinOnePercent
    Image image(256, 256, 1);
    for (unsigned bits = 0; bits < 65536; ++bits) {
        half value;
        value.setBits(static_cast<unsigned short>(bits));
        image.floats()[bits] = value;
    }
    write_one(folder_ / "a.exr", "data", PixelType::half, image, compression());
    const Image read = read_floats(folder_ / "a.exr", {"data"});
    for (unsigned bits = 0; bits < 65536; ++bits) {
        ASSERT_EQ(half(read.floats()[bits]).bits(), bits);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(read.floats()[bits]),
                  std::bit_cast<std::uint32_t>(image.floats()[bits]));
    }
}

TEST_P(EveryCompression, KeepsFloatsThatPxr24DoesNotRound) {
    Image image(45, 37, 1);
    for (std::size_t i = 0; i < image.floats().size(); ++i)
        image.floats()[i] = std::exp(float(i) * 0.05f - 40.0f);
    image.at(0, 0, 0) = kInfinity;
    image.at(1, 0, 0) = -kInfinity;
    write_one(folder_ / "a.exr", "depth.Z", PixelType::float32, image, compression());
    const Image read = read_floats(folder_ / "a.exr", {"depth.Z"});
    for (std::size_t i = 0; i < image.floats().size(); ++i) {
        const float expected = image.floats()[i];
        // 24 of 32 bits remain: 15 of the mantissa.
        const float tolerance =
            compression() == "pxr24" && std::isfinite(expected) ? expected / 32768.0f : 0.0f;
        if (tolerance == 0.0f) ASSERT_EQ(read.floats()[i], expected) << i;
        else ASSERT_NEAR(read.floats()[i], expected, tolerance) << i;
    }
}

TEST_P(EveryCompression, KeepsUnsignedIntegers) {
    Image image(45, 37, 1, ComponentType::uint32);
    for (std::uint32_t i = 0; i < image.uints().size(); ++i) image.uints()[i] = i * 2654435761u;
    image.uint_at(0, 0, 0) = 0xffffffffu;
    write_one(folder_ / "a.exr", "object_id.I", PixelType::uint32, image, compression());
    const Image read = read_uints(folder_ / "a.exr", {"object_id.I"});
    EXPECT_TRUE(std::ranges::equal(read.uints(), image.uints()));
}

TEST_P(EveryCompression, KeepsSmoothHalfColorWithinOnePercent) {
    Image image(64, 48, 3);
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            for (int c = 0; c < 3; ++c)
                image.at(x, y, c) = 0.5f + 0.4f * std::sin(0.05f * float(x + y * 2 + c * 9));
        }
    }
    const std::vector<ExrOutputChannel> channels = {{"R", PixelType::half, &image, 0},
                                                    {"G", PixelType::half, &image, 1},
                                                    {"B", PixelType::half, &image, 2}};
    write_exr(folder_ / "a.exr", channels, options_for(image, compression()));
    const ExrFile file(folder_ / "a.exr");
    EXPECT_EQ(file.parts()[0].compression, compression());
    const Image read = file.read_floats(0, std::vector<std::string>{"R", "G", "B"});
    const bool lossy = is_b44() || compression().starts_with("dwa");
    for (std::size_t i = 0; i < image.floats().size(); ++i) {
        if (lossy) ASSERT_NEAR(read.floats()[i], image.floats()[i], 0.01f) << i;
        else ASSERT_EQ(read.floats()[i], float(half(image.floats()[i]))) << i;
    }
}

TEST(ExrFile, KeepsNegativeAndInfiniteDepth) {
    const TemporaryFolder folder;
    Image image(4, 1, 1);
    const float values[] = {-1.5f, kInfinity, -0.0f, 3.0e38f};
    std::ranges::copy(values, image.floats().begin());
    write_one(folder / "a.exr", "Z", PixelType::float32, image);
    const Image read = read_floats(folder / "a.exr", {"Z"});
    EXPECT_EQ(std::memcmp(read.floats().data(), values, sizeof values), 0);
}

TEST(ExrFile, RoundsToTheNearestEvenHalfAndOverflowsToInfinity) {
    const TemporaryFolder folder;
    Image image(6, 1, 1);
    const float step = 1.0f / 1024;
    const float values[] = {1 + step / 2, 1 + 1.5f * step, 65519.0f, 65520.0f, -1.0e9f, 1.0e-9f};
    const float expected[] = {1, 1 + 2 * step, 65504.0f, kInfinity, -kInfinity, 0};
    std::ranges::copy(values, image.floats().begin());
    write_one(folder / "a.exr", "Y", PixelType::half, image);
    EXPECT_TRUE(std::ranges::equal(read_floats(folder / "a.exr", {"Y"}).floats(), expected));
}

TEST(ExrFile, GivesChannelsInTheOrderAskedForAndTwiceIfAskedTwice) {
    const TemporaryFolder folder;
    const Image image = pattern_image(5, 4, 3);
    const std::vector<ExrOutputChannel> channels = {{"R", PixelType::half, &image, 0},
                                                    {"G", PixelType::float32, &image, 1},
                                                    {"B", PixelType::half, &image, 2}};
    write_exr(folder / "a.exr", channels, options_for(image));
    const Image read = read_floats(folder / "a.exr", {"G", "B", "R", "B"});
    ASSERT_EQ(read.channels(), 4);
    const int components[] = {1, 2, 0, 2};
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x) {
            for (int c = 0; c < 4; ++c) ASSERT_EQ(read.at(x, y, c), pattern(x, y, components[c]));
        }
    }
}

TEST(ExrFile, ListsTheChannelsThatThePartHasWhenOneIsMissing) {
    const TemporaryFolder folder;
    const Image image = pattern_image(2, 2, 1);
    std::vector<ExrOutputChannel> channels;
    for (int i = 0; i < 20; ++i)
        channels.push_back({"c" + std::to_string(10 + i), PixelType::half, &image, 0});
    write_exr(folder / "a.exr", channels, options_for(image));
    const std::string message = capture_error([&] {
        read_floats(folder / "a.exr", {"c10", "velocity.X", "Q"});
    });
    EXPECT_EQ(
        message,
        (folder / "a.exr").string() +
            ": the file has no channel 'velocity.X', 'Q'; it has c10, c11, c12, c13, c14, c15, c16, c17, "
            "c18, c19, c20, c21 and 8 more");
}

TEST(ExrFile, ReadsOnlyUintChannelsAsUints) {
    const TemporaryFolder folder;
    Image ids(3, 1, 1, ComponentType::uint32);
    ids.uint_at(2, 0, 0) = 77;
    write_one(folder / "ids.exr", "I", PixelType::uint32, ids);
    EXPECT_EQ(read_floats(folder / "ids.exr", {"I"}).at(2, 0, 0), 77.0f);
    write_one(folder / "z.exr", "Z", PixelType::float32, pattern_image(2, 2, 1));
    const std::string message = capture_error([&] { read_uints(folder / "z.exr", {"Z"}); });
    EXPECT_EQ(message, (folder / "z.exr").string() + ": channel 'Z' is of type float, expected uint");
}

TEST(ExrFile, KeepsWindowsThatAreNegativeOrFarOff) {
    const TemporaryFolder folder;
    const Image image = pattern_image(30, 21, 1);
    const ExrOutputChannel channel{"Z", PixelType::float32, &image, 0};
    for (const int origin : {-17, 1000000000, -1000000000}) {
        ExrWriteOptions options;
        options.data_window = {origin, origin - 3, origin + 29, origin + 17};
        options.display_window = {-5, 7, 44, 90};
        options.pixel_aspect = 1.5f;
        write_exr(folder / "a.exr", {&channel, 1}, options);
        const ExrFile file(folder / "a.exr");
        EXPECT_EQ(file.parts()[0].data_window, options.data_window);
        EXPECT_EQ(file.parts()[0].display_window, options.display_window);
        EXPECT_EQ(file.parts()[0].pixel_aspect, 1.5f);
        const Image read = file.read_floats(0, std::vector<std::string>{"Z"});
        EXPECT_TRUE(std::ranges::equal(read.floats(), image.floats()));
    }
}

TEST(ExrFile, GivesTheSamePixelsWithAnyThreadCount) {
    const TemporaryFolder folder;
    const Image image = pattern_image(100, 333, 2);
    const std::vector<ExrOutputChannel> channels = {{"A", PixelType::half, &image, 0},
                                                    {"B", PixelType::float32, &image, 1}};
    std::set<std::string> files;
    for (const int threads : {0, 1, 4}) {
        set_exr_threads(threads);
        write_exr(folder / "a.exr", channels, options_for(image, "piz"));
        files.insert(test::read_text(folder / "a.exr"));
        const Image read = read_floats(folder / "a.exr", {"A", "B"});
        EXPECT_TRUE(std::ranges::equal(read.floats(), image.floats())) << threads;
    }
    set_exr_threads(0);
    EXPECT_EQ(files.size(), 1u);
}

struct TiledCase {
    Imf::LevelMode mode;
    Imf::LevelRoundingMode rounding;
    Imf::LineOrder order;
    Imf::Compression compression;
};

void write_tiled(const fs::path& path, const Imath::Box2i& window, const TiledCase& how,
                 int written_levels = 100) {
    Imf::Header header(window, window);
    header.compression() = how.compression;
    header.lineOrder() = how.order;
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(16, 8, how.mode, how.rounding));
    const Image full = pattern_image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, 1);
    const std::vector<float> other(full.floats().size(), -99.0f);
    Imf::TiledOutputFile file(path.c_str(), header);
    for (int y = 0; y < file.numYLevels(); ++y) {
        for (int x = 0; x < file.numXLevels(); ++x) {
            if (!file.isValidLevel(x, y) || x + y >= written_levels) continue;
            const float* pixels = x + y == 0 ? full.floats().data() : other.data();
            Imf::FrameBuffer frame;
            frame.insert("Z", Imf::Slice::Make(Imf::FLOAT, pixels, window));
            file.setFrameBuffer(frame);
            file.writeTiles(0, file.numXTiles(x) - 1, 0, file.numYTiles(y) - 1, x, y);
        }
    }
}

TEST(ExrFile, ReadsLevelZeroOfTiledFilesWithPartialEdgeTiles) {
    const TemporaryFolder folder;
    const Imath::Box2i window({-9, 5}, {40, 32});
    const Image expected = pattern_image(50, 28, 1);
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
        for (const Imf::LevelRoundingMode rounding : {Imf::ROUND_DOWN, Imf::ROUND_UP}) {
            for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y, Imf::RANDOM_Y}) {
                for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION}) {
                    write_tiled(folder / "a.exr", window, {mode, rounding, order, compression});
                    const ExrFile file(folder / "a.exr");
                    EXPECT_EQ(file.parts()[0].type, "tiledimage");
                    const Image read = file.read_floats(0, std::vector<std::string>{"Z"});
                    ASSERT_TRUE(std::ranges::equal(read.floats(), expected.floats()))
                        << mode << rounding << order;
                }
            }
        }
    }
}

TEST(ExrFile, RefusesTiledFilesWithoutLevelZero) {
    const TemporaryFolder folder;
    write_tiled(folder / "a.exr", Imath::Box2i({0, 0}, {40, 32}),
                {Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION}, 0);
    const std::string message = capture_error([&] { read_floats(folder / "a.exr", {"Z"}); });
    EXPECT_NE(message.find("incomplete: 15 of 15 blocks are missing, the first is the tile at (0, 0)"),
              std::string::npos)
        << message;
}

TEST(ExrFile, ReadsPartsWithTheirOwnWindowsNamesAndViews) {
    const TemporaryFolder folder;
    const Imath::Box2i display({0, 0}, {63, 47});
    const std::vector<Imath::Box2i> windows = {display, Imath::Box2i({10, -4}, {20, 30}),
                                               Imath::Box2i({-3, 7}, {70, 9})};
    std::vector<Imf::Header> headers;
    std::vector<Image> images;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        Imf::Header header(display, windows[i]);
        header.setName("part" + std::to_string(i));
        header.setView(i == 2 ? "left" : "right");
        header.setType(i == 1 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
        if (i == 1) header.setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        headers.push_back(header);
        images.push_back(pattern_image(windows[i].max.x - windows[i].min.x + 1,
                                       windows[i].max.y - windows[i].min.y + 1, 1));
    }
    {
        Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), int(headers.size()));
        for (const int i : {2, 0}) {
            Imf::OutputPart part(file, i);
            Imf::FrameBuffer frame;
            frame.insert("Z", Imf::Slice::Make(Imf::FLOAT, images[std::size_t(i)].floats().data(),
                                               windows[std::size_t(i)]));
            part.setFrameBuffer(frame);
            part.writePixels(images[std::size_t(i)].height());
        }
    }
    const ExrFile file(folder / "a.exr");
    ASSERT_EQ(file.parts().size(), 3u);
    for (const int i : {0, 2}) {
        const ExrPart& part = file.parts()[std::size_t(i)];
        EXPECT_EQ(part.name, "part" + std::to_string(i));
        EXPECT_EQ(part.view, i == 2 ? "left" : "right");
        EXPECT_EQ(part.data_window.min_x, windows[std::size_t(i)].min.x);
        EXPECT_EQ(part.data_window.height(), images[std::size_t(i)].height());
        const Image read = file.read_floats(i, std::vector<std::string>{"Z"});
        EXPECT_TRUE(std::ranges::equal(read.floats(), images[std::size_t(i)].floats())) << i;
    }
    const std::string missing = capture_error([&] { read_floats(folder / "a.exr", {"R"}, 2); });
    EXPECT_NE(missing.find(": part 2 'part2' has no channel 'R'; it has Z"), std::string::npos) << missing;
    const std::string unwritten = capture_error([&] { read_floats(folder / "a.exr", {"Z"}, 1); });
    EXPECT_NE(unwritten.find(": incomplete: 10 of 10 blocks"), std::string::npos) << unwritten;
}

TEST(ExrFile, RefusesDeepAndSubsampledParts) {
    const TemporaryFolder folder;
    {
        Imf::Header header(8, 8);
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        Imf::DeepScanLineOutputFile((folder / "deep.exr").c_str(), header);
        Imf::Header chroma(8, 8);
        chroma.channels().insert("Y", Imf::Channel(Imf::HALF));
        chroma.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
        Imf::OutputFile file((folder / "yc.exr").c_str(), chroma);
        const std::vector<half> pixels(64, half(0.5f));
        Imf::FrameBuffer frame;
        frame.insert("Y", Imf::Slice::Make(Imf::HALF, pixels.data(), chroma.dataWindow()));
        frame.insert("RY", Imf::Slice::Make(Imf::HALF, pixels.data(), chroma.dataWindow(), 2, 8, 2, 2));
        file.setFrameBuffer(frame);
        file.writePixels(8);
    }
    const std::string deep = capture_error([&] { read_floats(folder / "deep.exr", {"Z"}); });
    EXPECT_NE(
        deep.find(": the file is of type 'deepscanline', deep data is not supported; flatten it: oiiotool "),
        std::string::npos)
        << deep;
    const std::string chroma = capture_error([&] { read_floats(folder / "yc.exr", {"Y", "RY"}); });
    EXPECT_NE(chroma.find(": channel 'RY' is subsampled 2 x 2"), std::string::npos) << chroma;
    EXPECT_EQ(read_floats(folder / "yc.exr", {"Y"}).at(7, 7, 0), 0.5f);
}

}  // namespace
}  // namespace aftershade
