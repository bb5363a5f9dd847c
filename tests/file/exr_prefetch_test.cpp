// Channels that are unpacked together must be those that single reads give, and nothing must be read twice.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "tests/file/image_files.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using test::capture_error;
using test::TemporaryFolder;

using Names = std::vector<std::string>;

std::vector<float> floats(const ExrFile& file, const Names& names) {
    const Image image = file.read_floats(0, names);
    return {image.floats().begin(), image.floats().end()};
}

std::vector<std::uint32_t> uints(const ExrFile& file, const Names& names) {
    const Image image = file.read_uints(0, names);
    return {image.uints().begin(), image.uints().end()};
}

class ExrPrefetch : public testing::Test {
protected:
    ExrPrefetch() {
        Image light(64, 40, 3), ids(64, 40, 1, ComponentType::uint32);
        for (std::size_t i = 0; i < light.floats().size(); ++i) light.floats()[i] = float((i * 7919) % 1001);
        for (std::size_t i = 0; i < ids.uints().size(); ++i) ids.uints()[i] = std::uint32_t(i * 2654435761U);
        const std::vector<ExrOutputChannel> channels = {{"B", PixelType::float32, &light, 2},
                                                        {"G", PixelType::half, &light, 1},
                                                        {"R", PixelType::float32, &light, 0},
                                                        {"id", PixelType::uint32, &ids, 0}};
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 63, 39};
        write_exr(path_, channels, options);
    }

    TemporaryFolder folder_;
    fs::path path_ = folder_ / "light.exr";
    const Names rg_{"R", "G"}, b_{"B"}, id_{"id"};
};

TEST_F(ExrPrefetch, GivesTheBitsOfSingleReads) {
    const ExrFile one_by_one(path_), together(path_);
    together.prefetch(std::vector<ExrRequest>{
        {0, rg_, ComponentType::float32}, {0, b_, ComponentType::float32}, {0, id_, ComponentType::uint32}});
    EXPECT_EQ(uints(together, id_), uints(one_by_one, id_));
    EXPECT_EQ(floats(together, rg_), floats(one_by_one, rg_));
    EXPECT_EQ(floats(together, b_), floats(one_by_one, b_));
    EXPECT_EQ(floats(together, rg_), floats(one_by_one, rg_)) << "once more";
    EXPECT_EQ(floats(together, id_), floats(one_by_one, id_)) << "as floats";
}

TEST_F(ExrPrefetch, ReadsTheFileNoMore) {
    const std::vector<float> expected = floats(ExrFile(path_), b_);
    const ExrFile file(path_);
    file.prefetch(std::vector<ExrRequest>{{0, rg_, ComponentType::float32}, {0, b_, ComponentType::float32}});
    fs::resize_file(path_, 400);  // the pixels are gone
    EXPECT_EQ(floats(file, b_), expected);
    EXPECT_NE(capture_error([&] { file.read_floats(0, b_); }), "") << "what is kept is given once";
}

TEST_F(ExrPrefetch, LeavesWhatItCannotReadToTheReads) {
    const ExrFile file(path_);
    file.prefetch(
        std::vector<ExrRequest>{{0, rg_, ComponentType::float32}, {0, {"nothing"}, ComponentType::float32}});
    EXPECT_NE(capture_error([&] { file.read_floats(0, Names{"nothing"}); }).find("nothing"),
              std::string::npos);
    EXPECT_EQ(file.read_floats(0, rg_).width(), 64);

    const ExrFile small(path_, {.max_image_bytes = 64 * 40 * 4 * 2});
    small.prefetch(
        std::vector<ExrRequest>{{0, rg_, ComponentType::float32}, {0, b_, ComponentType::float32}});
    EXPECT_EQ(small.read_floats(0, rg_).width(), 64) << "each within the limit, together beyond it";
    EXPECT_EQ(small.read_floats(0, b_).width(), 64);
}

TEST_F(ExrPrefetch, TakesEachChannelOnce) {
    const ExrFile one_by_one(path_), file(path_);
    const Names gr{"G", "R"};
    file.prefetch(std::vector<ExrRequest>{
        {0, rg_, ComponentType::float32}, {0, gr, ComponentType::float32}, {0, b_, ComponentType::float32}});
    for (const Names& names : {rg_, gr, b_}) EXPECT_EQ(floats(file, names), floats(one_by_one, names));
}

}  // namespace
}  // namespace aftershade
