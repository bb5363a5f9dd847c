#include "framework/file/exr_file.h"
#include "tests/file/deep_files.h"
#include "tests/file/image_files.h"

#include <gtest/gtest.h>

#include <cstring>

namespace aftershade::test {
namespace {

/// Pixel i of 9 x 7 has i % 4 samples.
DeepImage deep_pattern() {
    std::vector<std::vector<DeepValues>> pixels(63);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        for (std::size_t s = 0; s < i % 4; ++s)
            pixels[i].push_back({float(i) + 0.25f * float(s), 1.0f / float(s + 2), float(i * 10 + s)});
    DeepImage image = deep_image(9, {"Z", "A", "id"}, pixels);
    DeepImage::Channel& ids = image.channels.back();
    ids.uints.assign(ids.floats.begin(), ids.floats.end());
    for (std::uint32_t& id : ids.uints) id += 1u << 25;  // what a float would round
    ids.floats.clear();
    return image;
}

void expect_pattern(const std::filesystem::path& path) {
    const DeepImage expected = deep_pattern();
    const DeepImage read = ExrFile(path).read_deep(0, std::vector<std::string>{"id", "Z", "A"});
    EXPECT_EQ(read.width, 9);
    EXPECT_EQ(read.first, expected.first);
    EXPECT_EQ(read.find("Z")->floats, expected.find("Z")->floats);
    EXPECT_EQ(read.find("A")->floats, expected.find("A")->floats);
    EXPECT_EQ(read.find("id")->uints, expected.find("id")->uints);
}

std::string error_of_file(const std::filesystem::path& path, const ReadLimits& limits = {}) {
    return capture_error([&] {
        (void)ExrFile(path, limits).read_deep(0, std::vector<std::string>{"Z", "A", "id"});
    });
}

TEST(DeepFiles, OfScanLinesAndTilesAreReadSampleBySample) {
    const TemporaryFolder folder;
    for (const int tile : {0, 4, 16})
        for (const Imf::Compression compression :
             {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION}) {
            SCOPED_TRACE(std::to_string(tile) + " " + std::to_string(compression));
            write_deep(folder / "a.exr", deep_pattern(), {tile, compression, -3, 5});
            expect_pattern(folder / "a.exr");
            EXPECT_EQ(ExrFile(folder / "a.exr").read_deep(0, {}).first,
                      deep_pattern().first);  // counts alone
        }
}

TEST(DeepFiles, NameWhatTheyDoNotHave) {
    const TemporaryFolder folder;
    write_deep(folder / "a.exr", deep_pattern());
    const ExrFile file(folder / "a.exr");
    EXPECT_NE(capture_error([&] {
                  (void)file.read_deep(0, std::vector<std::string>{"R"});
              }).find("has no channel 'R'; it has A, Z, id"),
              std::string::npos);
    EXPECT_NE(
        capture_error([&] { (void)file.read_floats(0, std::vector<std::string>{"Z"}); }).find("deep data"),
        std::string::npos);
}

/// 93 samples of three channels.
TEST(DeepFiles, AreHeldAgainstTheLimitBeforeThereIsMemoryForThem) {
    const TemporaryFolder folder;
    write_deep(folder / "a.exr", deep_pattern());
    ReadLimits limits;
    limits.max_image_bytes = 93 * 12;
    EXPECT_EQ(ExrFile(folder / "a.exr", limits)
                  .read_deep(0, std::vector<std::string>{"Z", "A", "id"})
                  .sample_count(),
              93u);
    limits.max_image_bytes = 93 * 12 - 1;
    EXPECT_NE(error_of_file(folder / "a.exr", limits)
                  .find("3 channels of 93 deep samples take 1116 bytes, the limit is 1115"),
              std::string::npos);
}

/// Position of the sizes in the head of the first of 7 lines. The table of their offsets ends where it
/// begins.
std::size_t first_sizes(const std::string& bytes) {
    for (std::size_t at = 8; at + 8 <= bytes.size(); ++at) {
        std::uint64_t offset = 0;
        std::memcpy(&offset, &bytes[at], 8);
        if (offset == at + 7 * 8) return std::size_t(offset) + 4;  // after the line's number
    }
    ADD_FAILURE() << "no block";
    return 0;
}

TEST(DeepFiles, ThatLieAboutTheirSizesAreRefused) {
    const TemporaryFolder folder;
    write_deep(folder / "good.exr", deep_pattern(), {0, Imf::NO_COMPRESSION, 0, 0});
    const std::string good = read_text(folder / "good.exr");
    const std::size_t sizes = first_sizes(good);
    const auto with = [&](std::size_t word, std::uint64_t value) {
        std::string bytes = good;
        std::memcpy(&bytes[sizes + word * 8], &value, 8);
        write_text(folder / "a.exr", bytes);
        return error_of_file(folder / "a.exr");
    };
    EXPECT_NE(with(0, std::uint64_t(1) << 40).find("cut off or damaged"), std::string::npos);
    EXPECT_NE(with(0, 32).find("damaged: lines 0 to 0: its 9 sample counts are stored in 32 bytes"),
              std::string::npos);
    EXPECT_NE(with(1, ~std::uint64_t(0)).find("cut off or damaged"), std::string::npos);
    EXPECT_NE(with(2, std::uint64_t(1) << 62).find("damaged: lines 0 to 0: its samples"), std::string::npos);
    // A count that is larger than the block: the first pixel's, which is 0.
    std::string bytes = good;
    const std::uint32_t more = 1u << 20;
    for (std::size_t pixel = 0; pixel < 9; ++pixel) std::memcpy(&bytes[sizes + 24 + pixel * 4], &more, 4);
    write_text(folder / "a.exr", bytes);
    const std::string message = error_of_file(folder / "a.exr");
    EXPECT_NE(message.find("amaged"), std::string::npos) << message;
}

TEST(DeepFiles, CutAtAnyByteAreRefused) {
    const TemporaryFolder folder;
    for (const int tile : {0, 4}) {
        write_deep(folder / "good.exr", deep_pattern(), {tile, Imf::ZIPS_COMPRESSION, 0, 0});
        const std::string good = read_text(folder / "good.exr");
        for (std::size_t size = 0; size < good.size(); size += 37) {
            write_text(folder / "a.exr", good.substr(0, size));
            EXPECT_FALSE(error_of_file(folder / "a.exr").empty()) << size;
        }
    }
}

/// Whatever a byte becomes, it ends in samples or in code 3.
TEST(DeepFiles, WithAnyByteChangedEndInSamplesOrAnError) {
    const TemporaryFolder folder;
    int refused = 0;
    for (const int tile : {0, 4}) {
        write_deep(folder / "good.exr", deep_pattern(), {tile, Imf::RLE_COMPRESSION, 0, 0});
        const std::string good = read_text(folder / "good.exr");
        for (std::size_t at = 0; at < good.size(); at += 11) {
            std::string bytes = good;
            bytes[at] = char(bytes[at] ^ 0xa5);
            write_text(folder / "a.exr", bytes);
            try {
                const ExrFile file(folder / "a.exr");
                if (!file.parts()[0].is_deep()) continue;
                (void)file.read_deep(0, std::vector<std::string>{"Z", "A"});
            } catch (const Error& error) {
                EXPECT_EQ(int(error.kind()), int(ErrorKind::capture)) << error.what();
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace aftershade::test
