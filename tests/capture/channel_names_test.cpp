// Names of channels as many programs spell them, and what is read from them. Each channel holds 1, 2, 3 ...
// in the order of its list, so that the value shows which one was read.
#include "framework/capture/channel_names.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/capture/capture_files.h"
#include "tests/capture/part_files.h"

namespace aftershade::test {
namespace {

using Names = std::vector<std::string>;

TEST(CanonicalName, IsOneForAllSpellings) {
    for (const char* name : {"View Layer.Combined.R", "View_Layer_Combined.red", "view-layer.combined.r",
                             ".View Layer.Combined.RED"})
        EXPECT_EQ(canonical_name(name), "view.layer.combined.r") << name;
    EXPECT_EQ(canonical_name("."), "");
    EXPECT_EQ(canonical_name("Alpha"), "a");
    EXPECT_EQ(canonical_name("alpha.V"), "alpha.v");
}

TEST(ChannelNames, AreALayerAndAComponent) {
    EXPECT_EQ(split_channel_name("main.beauty.R"), (ChannelName{"main.beauty", "r"}));
    EXPECT_EQ(split_channel_name(".G"), (ChannelName{"", "g"}));
    EXPECT_EQ(split_channel_name("beauty_green"), (ChannelName{"beauty", "g"}));
    EXPECT_EQ(split_channel_name("depth_z"), (ChannelName{"", "depth.z"}));
}

class NamedChannels : public testing::Test {
protected:
    Capture read(const Names& channels, const std::map<std::string, ExrValue>& attributes = {}) {
        std::vector<StoredChannel> stored;
        for (const std::string& name : channels)
            stored.push_back({name, std::vector<float>(2, float(stored.size() + 1))});
        write_channels(folder_ / "f.exr", 2, stored, attributes);
        sequence_.files = FramePattern((folder_ / "f.exr").string());
        Diagnostics diagnostics;
        const CaptureReader reader(sequence_, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics),
                                   {});
        return reader.read(1, Names{"color", "depth", "normal", "position", "object_id", "velocity"});
    }
    /// The first value of each component.
    static std::vector<float> values(const Capture& capture, const std::string& role) {
        const auto found = capture.images.find(role);
        if (found == capture.images.end()) return {};
        const auto all = found->second.floats();
        return {all.begin(), all.begin() + found->second.channels()};
    }
    using Values = std::vector<float>;

    TemporaryFolder folder_;
    Sequence sequence_;
};

TEST_F(NamedChannels, HaveTheirAlphaUnderAnyUsualName) {
    for (const Names& channels : {Names{"R", "G", "B", "alpha"},
                                  {"R", "G", "B", "a"},
                                  {"Ci.r", "Ci.g", "Ci.b", "a"},
                                  {"beauty.R", "beauty.G", "beauty.B", "A"},
                                  {"rgb.R", "rgb.G", "rgb.B", "alpha.V"},
                                  {"main.rgb.R", "main.rgb.G", "main.rgb.B", "main.Alpha.Y"},
                                  {".R", ".G", ".B", ".A"},
                                  {"red", "green", "blue", "ALPHA"},
                                  {"beauty_R", "beauty_G", "beauty_B", "beauty_A"}})
        EXPECT_EQ(values(read(channels), "color"), (Values{1, 2, 3, 4})) << channels[0] << channels[3];
    // An alpha beside another colour is of that one.
    EXPECT_EQ(values(read({"R", "G", "B", "A", "diffuse.R", "diffuse.G", "diffuse.B"}), "color"),
              (Values{1, 2, 3, 4}));
    sequence_.layer = "diffuse";
    EXPECT_EQ(values(read({"R", "G", "B", "A", "diffuse.R", "diffuse.G", "diffuse.B"}), "color"),
              (Values{5, 6, 7, 1}));
}

TEST_F(NamedChannels, HaveTheirDepthUnderAnyUsualName) {
    for (const auto& [red, depth] :
         std::initializer_list<std::pair<std::string, std::string>>{{"rgba.r", "depth.z"},
                                                                    {"RGBA.R", "RGBA.Z"},
                                                                    {"main.beauty.R", "main.depth.Z"},
                                                                    {"C.r", "Pz"},
                                                                    {"R", "Z-depth.R"},
                                                                    {"R", "zdepth.V"},
                                                                    {"R", "main.depth.Z"},
                                                                    {"A_Combined.red", "A_Depth.Z"},
                                                                    {"beauty.R", "Z_Depth.Y"},
                                                                    {".R", ".Z"},
                                                                    {"R", "DEPTH"}}) {
        const std::string head = red.substr(0, red.find_last_of("._") + 1);
        const Names rgb = red == "A_Combined.red" ? Names{red, head + "green", head + "blue"}
                          : red.back() == 'r'     ? Names{red, head + "g", head + "b"}
                                                  : Names{red, head + "G", head + "B"};
        EXPECT_EQ(values(read({rgb[0], rgb[1], rgb[2], depth}), "depth"), (Values{4})) << red << depth;
    }
}

TEST_F(NamedChannels, OfAnotherThingAreNoDepth) {
    EXPECT_EQ(values(read({"R", "G", "B", "P.X", "P.Y", "P.Z"}), "depth"), Values{});
    EXPECT_EQ(values(read({"R", "G", "B", "left.depth.Z", "right.depth.Z"}), "depth"), Values{});
    EXPECT_EQ(values(read({"main.R", "main.G", "main.B", "main.X", "main.Y", "main.Z"}), "depth"), Values{});
}

TEST_F(NamedChannels, OfLayersAreThoseOfTheLayerThatWasChosen) {
    const Names channels = {"A_Combined.red", "A_Combined.green", "A_Combined.blue", "A_Depth.Z",
                            "B_Combined.red", "B_Combined.green", "B_Combined.blue", "B_Depth.Z"};
    Capture capture = read(channels);
    EXPECT_EQ(capture.header.profile, "blender");
    EXPECT_EQ(capture.header.layers, (Names{"A", "B"}));
    EXPECT_EQ(values(capture, "depth"), (Values{4}));
    sequence_.layer = "B";
    EXPECT_EQ(values(read(channels), "color"), (Values{5, 6, 7, 1}));
    EXPECT_EQ(values(read(channels), "depth"), (Values{8}));
}

// 1e10 is Blender's "nothing hit", which only its profile knows.
TEST_F(NamedChannels, OfBlenderKeepTheirMeaningWhereNukeWroteThem) {
    std::vector<StoredChannel> stored;
    for (const char* name :
         {"View_Layer_Combined.red", "View_Layer_Combined.green", "View_Layer_Combined.blue"})
        stored.push_back({name, {1, 1}});
    stored.push_back({"View_Layer_Depth.Z", {3, 1e10f}});
    stored.push_back({"View_Layer_Vector.X", {2, 2}});
    stored.push_back({"View_Layer_Vector.Y", {5, 5}});
    write_channels(folder_ / "n.exr", 2, stored);
    sequence_.files = FramePattern((folder_ / "n.exr").string());
    Diagnostics diagnostics;
    const auto profiles = read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    const Capture capture = CaptureReader(sequence_, profiles, {}).read(1, Names{"depth", "velocity"});
    EXPECT_EQ(capture.header.profile, "blender");
    EXPECT_EQ(capture.images.at("depth").at(0, 0, 0), 3);
    EXPECT_TRUE(std::isinf(capture.images.at("depth").at(1, 0, 0)));
    EXPECT_EQ(values(capture, "velocity"), (Values{-2, 5}));
}

TEST_F(NamedChannels, OfNormalsAndPositionsAreReadAndTheirSpaceIsNoted) {
    const Capture capture = read({"R", "G", "B", "N.R", "N.G", "N.B", "P.X", "P.Y", "P.Z"});
    EXPECT_EQ(values(capture, "normal"), (Values{4, 5, 6}));
    EXPECT_EQ(values(capture, "position"), (Values{7, 8, 9}));
    ASSERT_EQ(capture.header.notes.size(), 2u);
    EXPECT_EQ(capture.header.notes[0],
              "normal is read from 'N.R', 'N.G' and 'N.B' as of world space, which the file does not say");
}

// No name says which way its vectors point and how long a 1 is.
TEST_F(NamedChannels, OfMotionAreListedAndNotRead) {
    const Names channels = {"R", "G", "B", "MotionVectors.R", "MotionVectors.G"};
    EXPECT_EQ(values(read(channels), "velocity"), Values{});
    EXPECT_EQ(channels_of_motion(channels), (Names{"MotionVectors.R", "MotionVectors.G"}));
}

TEST_F(NamedChannels, ThatCaptureJsonNamesNeedNoProfile) {
    const Names channels = {"left eye.1", "left eye.2", "left eye.3", "far"};
    const std::string message = error_of(ErrorKind::capture, [&] { read(channels); });
    EXPECT_NE(message.find("'far', 'left eye.1', 'left eye.2' and 'left eye.3'"), std::string::npos)
        << message;
    RoleDecoding color, depth;
    color.layers = {{channels[0], channels[1], channels[2], "?"}};
    depth.layers = {{"far"}};
    sequence_.channels = {{"color", color}, {"depth", depth}};
    const Capture capture = read(channels);
    EXPECT_EQ(capture.header.profile, "native");
    EXPECT_EQ(values(capture, "color"), (Values{1, 2, 3, 1}));
    EXPECT_EQ(values(capture, "depth"), (Values{4}));
}

}  // namespace
}  // namespace aftershade::test
