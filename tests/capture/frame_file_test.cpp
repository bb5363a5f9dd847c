#include "framework/capture/frame_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <gtest/gtest.h>

#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

struct TestPart {
    std::string name;
    std::string view;
    std::vector<std::string> channels;
    Imath::Box2i data_window;
    float value = 0;
};

/// Every pixel of a part holds its value, plus a tenth for each channel.
void write_parts(const std::filesystem::path& path, const std::vector<TestPart>& parts) {
    std::vector<Imf::Header> headers;
    for (const TestPart& part : parts) {
        Imf::Header header(Imath::Box2i({0, 0}, {15, 7}), part.data_window);
        header.setName(part.name);
        header.setType(Imf::SCANLINEIMAGE);
        if (!part.view.empty()) header.setView(part.view);
        for (const std::string& channel : part.channels)
            header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
        headers.push_back(header);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Imath::Box2i window = parts[i].data_window;
        const std::size_t width = std::size_t(window.max.x - window.min.x + 1);
        const std::size_t height = std::size_t(window.max.y - window.min.y + 1);
        std::vector<std::vector<float>> planes;
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < parts[i].channels.size(); ++c)
            planes.emplace_back(width * height, parts[i].value + 0.1f * float(c));
        for (std::size_t c = 0; c < planes.size(); ++c)
            frame.insert(parts[i].channels[c], Imf::Slice::Make(Imf::FLOAT, planes[c].data(), window));
        Imf::OutputPart output(file, int(i));
        output.setFrameBuffer(frame);
        output.writePixels(int(height));
    }
}

std::vector<std::string> names_of(const FrameFile& file) {
    return channel_names(file.merged());
}

const Imath::Box2i kWhole({0, 0}, {15, 7});
const Window kGrid{0, 0, 15, 7};

TEST(FrameFile, PutsTheChannelsOfAllPartsTogether) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr",
                {{"beauty", "", {"R", "G", "B"}, kWhole, 1}, {"depth", "", {"Z"}, kWhole, 5}});
    const FrameFile file(folder / "a.exr", {}, "");
    EXPECT_EQ(names_of(file), (std::vector<std::string>{"B", "G", "R", "Z"}));
    const Image image = file.read_floats(std::vector<std::string>{"R", "Z"}, kGrid, 0);
    EXPECT_FLOAT_EQ(image.at(3, 3, 0), 1);
    EXPECT_FLOAT_EQ(image.at(3, 3, 1), 5);
}

TEST(FrameFile, NamesAChannelByItsPartWhereAnotherPartHasTheNameAlready) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {{"Beauty", "", {"R"}, kWhole, 1}, {"Depth", "", {"R"}, kWhole, 5}});
    const FrameFile file(folder / "a.exr", {}, "");
    EXPECT_EQ(names_of(file), (std::vector<std::string>{"R", "Depth.R"}));
    EXPECT_FLOAT_EQ(file.read_floats(std::vector<std::string>{"Depth.R"}, kGrid, 0).at(0, 0, 0), 5);
}

TEST(FrameFile, ReadsOneViewAndWhatBelongsToNone) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {{"rgb_right", "right", {"R"}, kWhole, 1},
                                   {"rgb_left", "left", {"R"}, kWhole, 2},
                                   {"matte", "", {"mask.V"}, kWhole, 3}});
    const auto first_red = [&](const std::string& view) {
        return FrameFile(folder / "a.exr", {}, view)
            .read_floats(std::vector<std::string>{"R"}, kGrid, 0)
            .at(0, 0, 0);
    };
    EXPECT_FLOAT_EQ(first_red(""), 1);
    EXPECT_FLOAT_EQ(first_red("right"), 1);
    EXPECT_FLOAT_EQ(first_red("left"), 2);
    EXPECT_EQ(names_of(FrameFile(folder / "a.exr", {}, "left")), (std::vector<std::string>{"R", "mask.V"}));
}

TEST(FrameFile, PlacesAPartOfAnotherWindowAndFillsWhatItDoesNotCover) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr",
                {{"rgb", "", {"R"}, kWhole, 1}, {"depth", "", {"Z"}, {{4, 2}, {20, 5}}, 7}});
    const FrameFile file(folder / "a.exr", {}, "");
    const Image depth = file.read_floats(std::vector<std::string>{"Z"}, kGrid, -1);
    EXPECT_EQ(depth.width(), 16);
    EXPECT_FLOAT_EQ(depth.at(4, 2, 0), 7);
    EXPECT_FLOAT_EQ(depth.at(15, 5, 0), 7);
    EXPECT_FLOAT_EQ(depth.at(3, 2, 0), -1);
    EXPECT_FLOAT_EQ(depth.at(4, 6, 0), -1);
}

TEST(FrameFile, TakesViewsInNamesForLayersWhereTheFileNamesNoViews) {
    const TemporaryFolder folder;
    const Image image(2, 2, 5);
    const std::vector<std::string> stored = {"R", "left.R", "motion.right.u", "motion.left.u", "mask.V"};
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 5; ++c) channels.push_back({stored[std::size_t(c)], PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 1};
    write_exr(folder / "plain.exr", channels, options);
    // Without the attribute multiView these are layers called "left" and "motion.right".
    EXPECT_EQ(names_of(FrameFile(folder / "plain.exr", {}, "")).size(), 5u);
    EXPECT_NE(capture_error([&] { FrameFile(folder / "plain.exr", {}, "left"); }).find("names no views"),
              std::string::npos);
}

}  // namespace
}  // namespace aftershade::test
