// Scan lines that are unpacked without OpenEXR's line buffers, against OpenEXR's own reader.
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "tests/file/image_files.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using Bits = std::vector<std::uint32_t>;

/// One value of 4 bytes a pixel, which a file stores as its type.
struct Plane {
    Imf::PixelType type = Imf::FLOAT;
    Bits values;
};
using Planes = std::map<std::string, Plane>;

Imf::FrameBuffer frame_of(Planes& planes, const Imath::Box2i& box, bool as_stored) {
    const auto width = std::size_t(box.max.x - box.min.x + 1);
    Imf::FrameBuffer frame;
    for (auto& [name, plane] : planes) {
        const std::size_t bytes = as_stored && plane.type == Imf::HALF ? 2 : 4;
        frame.insert(name, Imf::Slice::Make(as_stored ? plane.type : Imf::FLOAT, plane.values.data(), box,
                                            bytes, bytes * width));
    }
    return frame;
}

/// The halves of the values' words are halfs where the type is half. Noise is stored as it is.
Planes make_planes(const Imath::Box2i& box, bool is_noise) {
    const std::size_t count = std::size_t(box.max.x - box.min.x + 1) * std::size_t(box.max.y - box.min.y + 1);
    std::mt19937 random{std::uint32_t(count)};
    Planes planes;
    for (const auto& [name, type] : std::map<std::string, Imf::PixelType>{{"B", Imf::HALF},
                                                                          {"G", Imf::FLOAT},
                                                                          {"Z", Imf::FLOAT},
                                                                          {"a.id", Imf::UINT},
                                                                          {"n.x", Imf::HALF}}) {
        Plane plane{type, {}};
        for (std::size_t i = 0; i < count; ++i)
            plane.values.push_back(is_noise ? std::uint32_t(random())
                                            : std::bit_cast<std::uint32_t>(float(i / 7) * 0.25f));
        planes.emplace(name, std::move(plane));
    }
    return planes;
}

/// The library's threads are not what is tested, and no sanitizer of threads sees their locks.
constexpr int kNoThreads = 0;

void write_planes(const fs::path& path, Planes planes, const Imath::Box2i& box, Imf::Compression method,
                  Imf::LineOrder order = Imf::INCREASING_Y) {
    Imf::Header header(box, box);
    header.compression() = method;
    header.lineOrder() = order;
    for (const auto& [name, plane] : planes) header.channels().insert(name, Imf::Channel(plane.type));
    Imf::OutputFile file(path.c_str(), header, kNoThreads);
    file.setFrameBuffer(frame_of(planes, box, true));
    file.writePixels(box.max.y - box.min.y + 1);
}

/// What the library reads as floats; nothing where it refuses the file.
std::optional<Planes> library_floats(const fs::path& path, Planes planes, const Imath::Box2i& box) {
    for (auto& [name, plane] : planes) std::ranges::fill(plane.values, 0u);
    try {
        Imf::InputFile file(path.c_str(), kNoThreads);
        file.setFrameBuffer(frame_of(planes, box, false));
        file.readPixels(box.min.y, box.max.y);
    } catch (const std::exception&) {
        return {};
    }
    return planes;
}

Bits bits_of(const Image& image, int component) {
    Bits bits;
    for (std::size_t i = std::size_t(component); i < image.floats().size();
         i += std::size_t(image.channels()))
        bits.push_back(std::bit_cast<std::uint32_t>(image.floats()[i]));
    return bits;
}

void expect_bits_of_library(const fs::path& path, const Planes& planes, const Imath::Box2i& box) {
    const std::optional<Planes> expected = library_floats(path, planes, box);
    ASSERT_TRUE(expected);
    const ExrFile file(path);
    const std::vector<std::string> all = {"n.x", "a.id", "Z", "G", "B"}, some = {"Z", "B"};
    for (const auto& names : {all, some}) {
        const Image image = file.read_floats(0, names);
        for (std::size_t i = 0; i < names.size(); ++i)
            EXPECT_EQ(bits_of(image, int(i)), expected->at(names[i]).values) << names[i];
    }
    const Image ids = file.read_uints(0, std::vector<std::string>{"a.id"});
    EXPECT_EQ(Bits(ids.uints().begin(), ids.uints().end()), planes.at("a.id").values);
}

TEST(ExrScanLines, HaveTheBitsOfTheLibrarysReaderInEveryShape) {
    const TemporaryFolder folder;
    const fs::path path = folder / "a.exr";
    const std::vector<Imath::Box2i> boxes = {{{0, 0}, {0, 0}},     {{0, 0}, {6, 0}},      {{-3, 5}, {-3, 37}},
                                             {{2, -17}, {18, -2}}, {{-40, -9}, {90, 30}}, {{1, 1}, {16, 32}}};
    for (const int threads : {0, 3}) {
        set_exr_threads(threads);
        for (const Imath::Box2i& box : boxes)
            for (const auto method : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION})
                for (const auto order : {Imf::INCREASING_Y, Imf::DECREASING_Y})
                    for (const bool is_noise : {false, true}) {
                        SCOPED_TRACE(testing::Message() << "from " << box.min << " to " << box.max
                                                        << ", method " << method << ", noise " << is_noise);
                        const Planes planes = make_planes(box, is_noise);
                        write_planes(path, planes, box, method, order);
                        expect_bits_of_library(path, planes, box);
                    }
    }
    set_exr_threads(0);
}

TEST(ExrScanLines, WidenEveryHalfAsTheLibraryDoes) {
    const TemporaryFolder folder;
    const Imath::Box2i box({0, 0}, {255, 255});
    Planes planes = make_planes(box, false);
    // Two halfs a word, the second in the upper half.
    for (std::size_t i = 0; i < 32768; ++i)
        planes["B"].values[i] = std::uint32_t(2 * i) | std::uint32_t(2 * i + 1) << 16;
    write_planes(folder / "a.exr", planes, box, Imf::ZIP_COMPRESSION);
    expect_bits_of_library(folder / "a.exr", planes, box);
}

/// Whatever byte of the pixels is damaged, a picture is the library's, and what it refuses is refused.
TEST(ExrScanLines, OfDamagedFilesAreTheLibrarysOrRefused) {
    const TemporaryFolder folder;
    const fs::path whole = folder / "a.exr", damaged = folder / "b.exr";
    const Imath::Box2i box({0, 0}, {8, 18});
    const Planes planes = make_planes(box, false);
    write_planes(whole, planes, box, Imf::ZIP_COMPRESSION);
    const std::string bytes = test::read_text(whole);
    std::size_t refused = 0;
    for (std::size_t at = 420; at < bytes.size(); ++at) {
        std::string changed = bytes;
        changed[at] = char(changed[at] ^ (1 << at % 8));
        std::ofstream(damaged, std::ios::binary) << changed;
        std::optional<Image> image;
        try {
            image = ExrFile(damaged).read_floats(0, std::vector<std::string>{"Z", "B"});
        } catch (const Error& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(damaged.string())) << error.what();
            ++refused;
        }
        const std::optional<Planes> expected = library_floats(damaged, planes, box);
        EXPECT_TRUE(expected || !image) << "byte " << at;
        if (!expected || !image) continue;
        EXPECT_EQ(bits_of(*image, 0), expected->at("Z").values) << "byte " << at;
        EXPECT_EQ(bits_of(*image, 1), expected->at("B").values) << "byte " << at;
    }
    EXPECT_GT(refused, bytes.size() / 4);
}

TEST(ExrScanLines, ThatAreCutOffAreRefused) {
    const TemporaryFolder folder;
    const fs::path path = folder / "a.exr";
    const Imath::Box2i box({0, 0}, {8, 18});
    for (const auto method : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION}) {
        write_planes(path, make_planes(box, false), box, method);
        fs::resize_file(path, fs::file_size(path) - 1);
        const std::string error =
            test::capture_error([&] { ExrFile(path).read_floats(0, std::vector<std::string>{"Z"}); });
        EXPECT_NE(error.find("cut off"), std::string::npos) << error;
    }
}

/// The library's reader gives back what we write, and the bytes before the blocks are the library's own.
TEST(ExrScanLines, ThatWeWriteAreReadBackByTheLibrary) {
    const TemporaryFolder folder;
    const fs::path ours = folder / "a.exr", theirs = folder / "b.exr";
    const std::vector<Imath::Box2i> boxes = {{{0, 0}, {0, 0}}, {{-3, 5}, {-3, 37}}, {{-40, -9}, {90, 30}}};
    for (const int threads : {0, 3})
        for (const Imath::Box2i& box : boxes)
            for (const bool is_noise : {false, true})
                for (const auto& [name, method] :
                     std::map<std::string, Imf::Compression>{{"none", Imf::NO_COMPRESSION},
                                                             {"zips", Imf::ZIPS_COMPRESSION},
                                                             {"zip", Imf::ZIP_COMPRESSION},
                                                             {"zip:1", Imf::ZIP_COMPRESSION},
                                                             {"zips:9", Imf::ZIPS_COMPRESSION}}) {
                    SCOPED_TRACE(testing::Message() << name << ", noise " << is_noise << ", " << box.max);
                    set_exr_threads(threads);
                    const Planes planes = make_planes(box, is_noise);
                    write_planes(theirs, planes, box, method);
                    const Planes expected = library_floats(theirs, planes, box).value();
                    const ExrFile source(theirs);
                    const std::vector<std::string> floats = {"B", "G", "Z", "n.x"};
                    const Image image = source.read_floats(0, floats);
                    const Image ids = source.read_uints(0, std::vector<std::string>{"a.id"});
                    const std::vector<ExrOutputChannel> channels = {{"a.id", PixelType::uint32, &ids, 0},
                                                                    {"n.x", PixelType::half, &image, 3},
                                                                    {"B", PixelType::half, &image, 0},
                                                                    {"Z", PixelType::float32, &image, 2},
                                                                    {"G", PixelType::float32, &image, 1}};
                    ExrWriteOptions options;
                    options.data_window =
                        options.display_window = {box.min.x, box.min.y, box.max.x, box.max.y};
                    options.compression = name;
                    write_exr(ours, channels, options);
                    const std::optional<Planes> read = library_floats(ours, planes, box);
                    ASSERT_TRUE(read);
                    for (const auto& [channel, plane] : *read)
                        EXPECT_EQ(plane.values, expected.at(channel).values) << channel;
                    if (method != Imf::NO_COMPRESSION) continue;
                    EXPECT_EQ(test::read_text(ours), test::read_text(theirs)) << "nothing was packed";
                }
    set_exr_threads(0);
}

TEST(ExrScanLines, ArePackedAtTheLevelThatTheTextNames) {
    EXPECT_EQ(exr_compression_level("zip:1"), 1);
    EXPECT_EQ(exr_compression_level("zips:9"), 9);
    for (const char* text : {"zip", "zip:", "zip:0", "zip:10", "piz:1", "zip:x", "zips:-1"})
        EXPECT_FALSE(exr_compression_level(text)) << text;
    const TemporaryFolder folder;
    const Image image = test::pattern_image(200, 100, 1);
    const std::vector<ExrOutputChannel> channels = {{"Z", PixelType::float32, &image, 0}};
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 199, 99};
    std::map<std::string, std::uintmax_t> sizes;
    for (const char* text : {"zip:1", "zip", "zip:9"}) {
        options.compression = text;
        write_exr(folder / "a.exr", channels, options);
        EXPECT_EQ(ExrFile(folder / "a.exr").parts()[0].compression, "zip");
        sizes[text] = fs::file_size(folder / "a.exr");
    }
    EXPECT_LT(sizes["zip:9"], sizes["zip:1"]);
    EXPECT_LE(sizes["zip"], sizes["zip:1"]);
    options.compression = "zip:0";
    const std::string error =
        test::error_of(ErrorKind::output, [&] { write_exr(folder / "a.exr", channels, options); });
    EXPECT_NE(error.find("1 (fastest) to 9"), std::string::npos) << error;
}

}  // namespace
}  // namespace aftershade
