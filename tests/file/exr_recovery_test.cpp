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
        return error_of(ExitCode::capture,
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

TEST(NewerCompression, IsNamedWithTheRemedy) {
    const TemporaryFolder folder;
    const fs::path path = written(folder);
    const std::string bytes = bytes_of(path), head("compression\0compression\0\1\0\0\0", 28);
    const std::size_t at = bytes.find(head) + head.size();
    for (const auto& [method, name] :
         {std::pair(10, "HTJ2K (OpenEXR 3.4)"), {13, "ZSTD (OpenEXR 3.5)"}, {99, "method 99"}}) {
        if (method < Imf::NUM_COMPRESSION_METHODS) continue;  // with a newer OpenEXR it is read
        std::string changed = bytes;
        changed[at] = char(method);
        write_bytes(path, changed);
        const std::string fault = error_of(ExitCode::capture, [&] { ExrFile{path}; });
        EXPECT_NE(fault.find("is compressed with " + std::string(name)), std::string::npos) << fault;
        EXPECT_NE(fault.find("oiiotool"), std::string::npos) << fault;
        EXPECT_EQ(fault.find("damaged"), std::string::npos) << fault;
    }
}

}  // namespace
}  // namespace aftershade::test
