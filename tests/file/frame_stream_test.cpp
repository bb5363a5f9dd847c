#include "framework/file/frame_stream.h"

#include <gtest/gtest.h>

#include <string>

namespace aftershade {
namespace {

TEST(FrameStream, WritesTheRatesOfNtscAsFractions) {
    const auto rate = [](double frames_per_second) {
        const std::string options = ffmpeg_input_options(StreamFormat::png, 8, 8, frames_per_second);
        return options.substr(options.rfind(' ') + 1);
    };
    EXPECT_EQ(rate(23.976), "24000/1001");
    EXPECT_EQ(rate(29.97), "30000/1001");
    EXPECT_EQ(rate(60000.0 / 1001), "60000/1001");
    EXPECT_EQ(rate(24), "24");
    EXPECT_EQ(rate(12.5), "12.5");
    EXPECT_EQ(rate(1000), "1000");
}

TEST(FrameStream, KnowsTheNamesThatItLists) {
    for (const std::string& name : stream_format_names()) EXPECT_TRUE(find_stream_format(name)) << name;
    EXPECT_EQ(find_stream_format("rgb48le"), StreamFormat::rgb48le);
    EXPECT_FALSE(find_stream_format("rgb"));
}

}  // namespace
}  // namespace aftershade
