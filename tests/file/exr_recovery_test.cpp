// Files that are whole although their headers or tables are not as usual.
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include <OpenEXR/ImfCompression.h>
#include <gtest/gtest.h>

#include "framework/file/exr_file.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 20, kHeight = 75, kBlocks = 5;  // ZIP: 16 lines a block

std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

fs::path written(const TemporaryFolder& folder) {
    const Image image = pattern_image(kWidth, kHeight, 1);
    const std::vector<ExrOutputChannel> channels = {{"Y", PixelType::half, &image, 0}};
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, kWidth - 1, kHeight - 1};
    write_exr(folder / "a.exr", channels, options);
    return folder / "a.exr";
}

/// Where the table of block offsets begins: its first entry names the byte behind its last.
std::size_t table_of(const std::string& bytes) {
    for (std::size_t at = 0; at + 8 * kBlocks < bytes.size(); ++at) {
        std::uint64_t first = 0;
        std::memcpy(&first, bytes.data() + at, sizeof first);
        if (first == at + 8 * kBlocks) return at;
    }
    ADD_FAILURE() << "no table";
    return 0;
}

std::string without_table(std::string bytes) {
    std::memset(bytes.data() + table_of(bytes), 0, 8 * kBlocks);
    return bytes;
}

TEST(EmptyBlockTable, IsMadeUpFromTheBlocks) {
    const TemporaryFolder folder;
    const fs::path path = written(folder);
    write_bytes(path, without_table(bytes_of(path)));
    const Image read = ExrFile(path).read_floats(0, std::vector<std::string>{"Y"});
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) ASSERT_EQ(read.at(x, y, 0), pattern(x, y, 0)) << x << " " << y;
}

TEST(EmptyBlockTable, OfBlocksThatAreNotWholeIsRefused) {
    const TemporaryFolder folder;
    const fs::path path = written(folder);
    const std::string bytes = without_table(bytes_of(path));
    const auto fault_of = [&](const std::string& damaged) {
        write_bytes(path, damaged);
        return error_of(ErrorKind::capture,
                        [&] { ExrFile(path).read_floats(0, std::vector<std::string>{"Y"}); });
    };
    EXPECT_NE(fault_of(bytes.substr(0, bytes.size() - 10)).find("incomplete: 5 of 5 blocks"),
              std::string::npos);
    std::string twice = bytes;  // the second block claims the first one's lines
    const std::size_t first = table_of(bytes_of(written(folder))) + 8 * kBlocks;
    std::int32_t size = 0;
    std::memcpy(&size, twice.data() + first + 4, sizeof size);
    std::memcpy(twice.data() + first + 8 + std::size_t(size), twice.data() + first, 4);
    EXPECT_NE(fault_of(twice).find("incomplete: 5 of 5 blocks"), std::string::npos);
}

TEST(EmptyBlockTable, OfAnotherProducersFileIsMadeUp) {
    AFTERSHADE_REQUIRE_CAPTURE(path, "producers/gaffer/zero_offset_table.exr");
    const ExrFile file(*path);
    const Image read = file.read_floats(0, std::vector<std::string>{file.parts()[0].channels[0].name});
    EXPECT_EQ(read.width(), file.parts()[0].data_window.width());
}

TEST(OddSampling, IsNamedWithItsChannelAndTheRemedy) {
    const TemporaryFolder folder;
    const fs::path path = written(folder);
    const ExrFile whole(path);
    const std::string name = whole.parts()[0].channels[0].name;
    const Window window = whole.parts()[0].data_window;
    std::string bytes = bytes_of(path);
    const std::size_t list = bytes.find(std::string("chlist\0", 7)) + 11;
    ASSERT_EQ(bytes.substr(list, name.size() + 1), name + '\0');
    const std::size_t sampling = list + name.size() + 1 + 8;  // after the type and four bytes
    const int across = window.width() + 1;
    std::memcpy(&bytes[sampling], &across, 4);
    write_bytes(path, bytes);
    const std::string fault = error_of(ErrorKind::capture, [&] { ExrFile{path}; });
    EXPECT_NE(fault.find("channel '" + name + "' has a sampling of " + std::to_string(across) +
                         " x 1, which does not divide the data window"),
              std::string::npos)
        << fault;
    EXPECT_NE(fault.find("(write the file with a sampling of 1 x 1)"), std::string::npos) << fault;
    EXPECT_EQ(fault.find("damaged"), std::string::npos) << fault;
    const int none = 0;
    std::memcpy(&bytes[sampling], &none, 4);
    write_bytes(path, bytes);
    EXPECT_NE(error_of(ErrorKind::capture, [&] { ExrFile{path}; }).find("damaged"), std::string::npos);
}

TEST(NewerCompression, ReadsBackToTheBitWhereTheLibraryHasIt) {
    const TemporaryFolder folder;
    const Image image = pattern_image(70, 300, 2);
    for (const std::string& name : exr_compression_names()) {
        if (is_lossy_compression(name)) continue;
        const std::vector<ExrOutputChannel> channels = {{"Z", PixelType::float32, &image, 0},
                                                        {"R", PixelType::half, &image, 1}};
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 69, 299};
        options.compression = name;
        const fs::path path = folder / (name + ".exr");
        write_exr(path, channels, options);
        const ExrFile file(path);
        EXPECT_EQ(file.parts()[0].compression, name);
        const Image read = file.read_floats(0, std::vector<std::string>{"Z"});
        for (int y = 0; y < 300; ++y)
            for (int x = 0; x < 70; ++x) ASSERT_EQ(read.at(x, y, 0), image.at(x, y, 0)) << name;
    }
}

TEST(NewerCompression, CannotBeWrittenByAnOlderLibraryWhichSaysSo) {
    if (Imf::NUM_COMPRESSION_METHODS > 13) GTEST_SKIP() << "this build's OpenEXR has all of them";
    const TemporaryFolder folder;
    const Image image(2, 2, 1);
    const std::vector<ExrOutputChannel> channels = {{"Z", PixelType::float32, &image, 0}};
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 1};
    options.compression = "zstd";
    const std::string fault =
        error_of(ErrorKind::output, [&] { write_exr(folder / "a.exr", channels, options); });
    EXPECT_NE(fault.find("compression 'zstd' needs OpenEXR 3.5, this build has "), std::string::npos)
        << fault;
}

TEST(NewerCompression, IsNamedWithTheRemedy) {
    const TemporaryFolder folder;
    const fs::path path = written(folder);
    const std::string bytes = bytes_of(path), head("compression\0compression\0\1\0\0\0", 28);
    const std::size_t at = bytes.find(head) + head.size();
    for (const auto& [method, name] :
         {std::pair(10, "htj2k256 (OpenEXR 3.4)"), {13, "zstd (OpenEXR 3.5)"}, {99, "method 99"}}) {
        if (method < Imf::NUM_COMPRESSION_METHODS) continue;  // with a newer OpenEXR it is read
        std::string changed = bytes;
        changed[at] = char(method);
        write_bytes(path, changed);
        const std::string fault = error_of(ErrorKind::capture, [&] { ExrFile{path}; });
        EXPECT_NE(fault.find("is compressed with " + std::string(name)), std::string::npos) << fault;
        EXPECT_NE(fault.find("oiiotool"), std::string::npos) << fault;
        EXPECT_EQ(fault.find("damaged"), std::string::npos) << fault;
    }
}

}  // namespace
}  // namespace aftershade::test
