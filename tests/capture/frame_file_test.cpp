#include "framework/capture/frame_file.h"

#include <gtest/gtest.h>

#include "tests/capture/part_files.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

std::vector<std::string> names_of(const FrameFile& file) {
    return channel_names(file.merged());
}

const Imath::Box2i kWhole = kWholePart;
const Window kGrid{0, 0, 15, 7};

TEST(FrameFile, PutsTheChannelsOfAllPartsTogether) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr",
                {{"beauty", "", {"R", "G", "B"}, kWhole, 1}, {"depth", "", {"Z"}, kWhole, 5}});
    const FrameFile file(folder / "a.exr", {}, "");
    EXPECT_EQ(names_of(file), (std::vector<std::string>{"B", "G", "R", "depth.Z"}));
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

// As Nuke writes a part for each layer (producers/nuke/channelTestNukePartPerLayer.exr).
TEST(FrameFile, TakesThePartsNameWithoutItsViewForTheLayer) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {{"character.main", "main", {"Z", "red"}, kWhole, 1},
                                   {"rgba.main", "main", {"R", "G", "B"}, kWhole, 2},
                                   {"depth.main", "main", {"Z"}, kWhole, 3},
                                   {"forward_main", "main", {"u", "v"}, kWhole, 4}});
    const FrameFile file(folder / "a.exr", {}, "");
    EXPECT_EQ(names_of(file), (std::vector<std::string>{"character.Z", "character.red", "B", "G", "R",
                                                        "depth.Z", "forward.u", "forward.v"}));
    // The part that holds depth alone is what Z means; its name with the layer is another name of it.
    for (const std::string name : {"Z", "depth.Z"})
        EXPECT_FLOAT_EQ(file.read_floats(std::vector<std::string>{name}, kGrid, 0).at(0, 0, 0), 3) << name;
    EXPECT_FLOAT_EQ(file.read_floats(std::vector<std::string>{"rgba.R"}, kGrid, 0).at(0, 0, 0), 2);
}

// As Nuke writes a part for each view: its own attributes stand in the first alone.
TEST(FrameFile, HasTheTextsOfEveryPart) {
    const TemporaryFolder folder;
    write_parts(folder / "a.exr", {{"right", "right", {"R"}, kWhole, 1, {{"nuke/version", "13.2v1"}}},
                                   {"left", "left", {"R"}, kWhole, 2}});
    const FrameFile left(folder / "a.exr", {}, "left");
    EXPECT_EQ(left.merged().metadata.text("nuke/version"), "13.2v1");
    EXPECT_EQ(left.merged().metadata.text("view"), "left");
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
