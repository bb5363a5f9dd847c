#include "framework/inspect/channel_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "tests/capture/capture_files.h"
#include "tests/not_finite.h"

namespace aftershade {
namespace {

using test::kInfinity;
using test::kNan;

Image image_of(int channels, const std::vector<float>& values) {
    Image image(int(values.size()) / channels, 1, channels);
    std::copy(values.begin(), values.end(), image.floats().begin());
    return image;
}

TEST(ChannelStatistics, CountWhatIsNotFiniteAndLeaveItOutOfTheRange) {
    const Image image = image_of(1, {3, kNan, -2, kInfinity, -kInfinity, kNan, kNan, 0.5f, -0.0f});
    const ChannelStatistics statistics = channel_statistics(image)[0];
    EXPECT_EQ(statistics.min, -2);
    EXPECT_EQ(statistics.max, 3);
    EXPECT_EQ(statistics.nan, 3);
    EXPECT_EQ(statistics.infinite, 2);
    EXPECT_EQ(statistics.negative, 2) << "-2 and -inf, but not -0";
}

TEST(ChannelStatistics, HaveNoRangeWhereNothingIsFinite) {
    const ChannelStatistics statistics = channel_statistics(image_of(1, {kNan, kInfinity}))[0];
    EXPECT_EQ(statistics.min, std::nullopt);
    EXPECT_EQ(statistics.max, std::nullopt);
    EXPECT_EQ(statistics.nan, 1);
    EXPECT_EQ(statistics.infinite, 1);
}

TEST(ChannelStatistics, AreOfOneChannelOfSeveral) {
    const Image image = image_of(3, {1, -5, 10, 2, kNan, 30, 3, -7, 20});
    EXPECT_EQ(channel_statistics(image)[0].max, 3);
    EXPECT_EQ(channel_statistics(image)[1].min, -7);
    EXPECT_EQ(channel_statistics(image)[1].max, -5);
    EXPECT_EQ(channel_statistics(image)[1].nan, 1);
    EXPECT_EQ(channel_statistics(image)[1].negative, 2);
    EXPECT_EQ(channel_statistics(image)[2].nan, 0);
    EXPECT_EQ(channel_statistics(image)[2].max, 30);
}

TEST(ChannelStatistics, KeepEveryBitOfUnsignedIntegers) {
    Image ids(2, 1, 1, ComponentType::uint32);
    ids.uints()[0] = 4294967295u;
    ids.uints()[1] = 16777217u;  // the first that a float has not
    const ChannelStatistics statistics = channel_statistics(ids)[0];
    EXPECT_EQ(statistics.max, 4294967295.0);
    EXPECT_EQ(statistics.min, 16777217.0);
    EXPECT_EQ(statistics.negative, 0);
}

TEST(ChannelStatistics, AreTheSameInPiecesOfALimitedSize) {
    const test::TemporaryFolder folder;
    test::write_channels(folder / "a.exr", 40,
                         {{"A", std::vector<float>(1600, 1)},
                          {"B", std::vector<float>(1600, -2)},
                          {"I", std::vector<float>(1600, 70000), PixelType::uint32},
                          {"Z", std::vector<float>(1600, kInfinity)}});
    ReadLimits limits;
    limits.max_image_bytes = 1600 * 4 + 4096;  // one channel and the header
    const ExrFile file(folder / "a.exr", limits);
    const std::vector<InspectedChannel> channels = inspect_channels(file, 0, limits);
    ASSERT_EQ(channels.size(), 4);
    for (const InspectedChannel& channel : channels) ASSERT_TRUE(channel.statistics) << channel.reason;
    EXPECT_EQ(channels[1].statistics->negative, 1600);
    EXPECT_EQ(channels[2].statistics->max, 70000);
    EXPECT_EQ(channels[3].statistics->infinite, 1600);
}

TEST(ChannelStatistics, SayWhyThereAreNone) {
    const test::TemporaryFolder folder;
    test::write_channels(folder / "a.exr", 64, {{"Z", std::vector<float>(64 * 64, 1.5f)}});
    std::string bytes = test::read_text(folder / "a.exr");
    bytes.resize(bytes.size() - 20);
    test::write_text(folder / "cut.exr", bytes);
    const ExrFile file(folder / "cut.exr");
    const std::vector<InspectedChannel> channels = inspect_channels(file, 0, {});
    ASSERT_EQ(channels.size(), 1);
    EXPECT_FALSE(channels[0].statistics);
    EXPECT_FALSE(channels[0].readable);
    EXPECT_TRUE(channels[0].reason.starts_with("cut off or damaged: ")) << channels[0].reason;
}

/// The numbers of the line "    Stats Min: 0.1 0.2 (float)".
std::vector<double> numbers_after(const std::string& text, const std::string& label) {
    std::istringstream in(text.substr(text.find(label) + label.size()));
    std::vector<double> numbers;
    for (double number; in >> number;) numbers.push_back(number);
    return numbers;
}

std::string oiiotool_stats(const std::filesystem::path& file) {
    std::FILE* pipe = popen(("oiiotool -v --stats '" + file.string() + "'").c_str(), "r");
    std::string text;
    for (int c; (c = std::fgetc(pipe)) != EOF;) text.push_back(char(c));
    pclose(pipe);
    return text;
}

/// oiiotool names the channels of a file in an order of its own.
std::vector<std::string> oiiotool_channels(const std::string& text) {
    const std::size_t begin = text.find("channel list: ") + 14;
    std::istringstream in(text.substr(begin, text.find('\n', begin) - begin));
    std::vector<std::string> names;
    for (std::string word; in >> word;)
        if (!word.starts_with('('))
            names.push_back(word.ends_with(',') ? word.substr(0, word.size() - 1) : word);
    return names;
}

TEST(ChannelStatistics, OfTheSuzanneFileAreThoseOfOiiotool) {
    if (std::system("command -v oiiotool >/dev/null") != 0) GTEST_SKIP() << "SKIPPED: no oiiotool";
    const std::filesystem::path path = AFTERSHADE_SOURCE_DIR "/scenes/suzanne/gbuffer_0003.exr";
    const std::string text = oiiotool_stats(path);
    const std::vector<std::string> names = oiiotool_channels(text);
    const std::vector<double> min = numbers_after(text, "Stats Min:"),
                              max = numbers_after(text, "Stats Max:");
    const std::vector<double> nan = numbers_after(text, "NanCount:"), inf = numbers_after(text, "InfCount:");
    ASSERT_EQ(names.size(), 25) << text;
    ASSERT_EQ(min.size(), 25) << text;
    ASSERT_EQ(inf.size(), 25) << text;
    for (const InspectedChannel& inspected : inspect_channels(ExrFile(path), 0, {})) {
        const std::string& name = inspected.channel.name;
        const auto found = std::find(names.begin(), names.end(), name);
        ASSERT_NE(found, names.end()) << name << "\n" << text;
        const std::size_t i = std::size_t(found - names.begin());
        ASSERT_TRUE(inspected.statistics) << inspected.reason;
        EXPECT_NEAR(*inspected.statistics->min, min[i], 1e-6 * std::abs(min[i]) + 1e-6)
            << name;  // six decimals
        EXPECT_NEAR(*inspected.statistics->max, max[i], 1e-6 * std::abs(max[i]) + 1e-6) << name;
        EXPECT_EQ(double(inspected.statistics->nan), nan[i]) << name;
        EXPECT_EQ(double(inspected.statistics->infinite), inf[i]) << name;
    }
}

}  // namespace
}  // namespace aftershade
