// Which channels a role is read from where names are a component alone: R of a colour is no depth.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/capture/capture_files.h"

namespace aftershade::test {
namespace {

using ChannelNames = std::vector<std::string>;

const std::vector<Profile>& profiles_as_shipped() {
    static const std::vector<Profile> profiles = [] {
        Diagnostics diagnostics;
        return read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    }();
    return profiles;
}

/// Files of two pixels whose channels hold 1, 2, 3 ... in the order given.
class RoleFiles : public testing::Test {
protected:
    RoleFiles() {
        write("color.exr", {"R", "G", "B"});
        sequence_ = sequence_of(folder_ / "color.exr", "falcor");
    }
    void write(const std::string& name, const ChannelNames& channels) {
        std::vector<StoredChannel> stored;
        for (const std::string& channel : channels)
            stored.push_back({channel, std::vector<float>(2, float(stored.size() + 1))});
        write_channels(folder_ / name, 2, stored);
    }
    void give(const std::string& role, const std::string& name, const ChannelNames& channels) {
        write(name, channels);
        sequence_.role_files.insert_or_assign(role, FramePattern((folder_ / name).string()));
    }
    CaptureHeader header() const {
        return CaptureReader(sequence_, profiles_as_shipped(), {}).read_header(1);
    }
    ChannelNames channels_of(const std::string& role) const { return header().role_channels.at(role); }
    std::string refusal() const {
        return error_of(ErrorKind::capture, [&] { header(); });
    }

    TemporaryFolder folder_;
    Sequence sequence_;
};

TEST_F(RoleFiles, AreNotTheFileOfTheColour) {
    EXPECT_EQ(header().roles, ChannelNames{"color"});
}

TEST_F(RoleFiles, OfFalcorHoldTheirPassAsRGB) {
    give("depth", "linearZ.exr", {"R", "G", "B"});
    give("velocity", "mvec.exr", {"R", "G", "B"});
    give("normal", "normW.exr", {"R", "G", "B"});
    EXPECT_EQ(header().roles, (ChannelNames{"color", "depth", "normal", "velocity"}));
    EXPECT_EQ(channels_of("depth"), ChannelNames{"R"});
    EXPECT_EQ(channels_of("velocity"), (ChannelNames{"R", "G"}));
    EXPECT_EQ(channels_of("normal"), (ChannelNames{"R", "G", "B"}));
}

/// LuxCore 2.11.2 writes DEPTH three times: the distance from the camera, +inf where nothing was hit.
TEST_F(RoleFiles, OfLuxcoreHoldTheirOutputAsRGB) {
    sequence_.profile = "luxcore";
    for (const char* role : {"albedo", "normal", "position"})
        give(role, std::string(role) + ".exr", {"R", "G", "B"});
    write_channels(folder_ / "DEPTH.exr", 2,
                   {{"R", {5, std::numeric_limits<float>::infinity()}}, {"G", {5, 5}}, {"B", {5, 5}}});
    sequence_.role_files.insert_or_assign("depth", FramePattern((folder_ / "DEPTH.exr").string()));
    EXPECT_EQ(header().roles, (ChannelNames{"albedo", "color", "depth", "normal", "position"}));
    EXPECT_EQ(channels_of("normal"), (ChannelNames{"R", "G", "B"}));
    sequence_.camera.set("focal_length", 36);
    sequence_.camera.set("sensor_width", 36);
    const Image depth = CaptureReader(sequence_, profiles_as_shipped(), {})
                            .read(1, std::vector<std::string>{"depth"})
                            .images.at("depth");
    // Two px wide, and so f is 2 px: the first one's middle lies 0.5 px beside the axis.
    EXPECT_NEAR(depth.at(0, 0, 0), 5 * 2 / std::hypot(2, 0.5), 1e-5);
    EXPECT_TRUE(std::isinf(depth.at(1, 0, 0)));
}

TEST_F(RoleFiles, OfGodotHoldTheirBufferAsImageSaveExrNamesIt) {
    sequence_.profile = "godot";
    give("depth", "depth.exr", {"R"});
    give("velocity", "velocity.exr", {"R", "G"});
    EXPECT_EQ(header().roles, (ChannelNames{"color", "depth", "velocity"}));
    EXPECT_EQ(channels_of("velocity"), (ChannelNames{"R", "G"}));
}

TEST_F(RoleFiles, OfUnrealAndUnityHoldTheDepthInR) {
    for (const char* profile : {"unreal", "unreal_half_screen", "unity"}) {
        sequence_.profile = profile;
        sequence_.role_files.clear();
        EXPECT_EQ(header().roles, ChannelNames{"color"}) << profile;
        give("depth", "z.exr", {"R", "G", "B", "A"});
        EXPECT_EQ(channels_of("depth"), ChannelNames{"R"}) << profile;
    }
}

TEST_F(RoleFiles, WithLayersHaveNoRoleUnderABareName) {
    give("depth", "aov.exr", {"R", "G", "B", "diffuse.R", "diffuse.G", "diffuse.B"});
    const std::string message = refusal();
    EXPECT_NE(message.find("aov.exr: which channel is depth is not known (it has 'B', 'G', 'R', 'diffuse.B', "
                           "'diffuse.G' and 'diffuse.R'; name it in capture.json: \"channels\": {\"depth\": "
                           "{\"channels\": [\"NAME\"]}})"),
              std::string::npos)
        << message;
}

TEST_F(RoleFiles, WithSeveralChannelsAreRefusedWhereTheProfileNamesNone) {
    sequence_.profile = "native";
    give("depth", "z.exr", {"R", "G", "B"});
    EXPECT_NE(refusal().find("which channel is depth is not known"), std::string::npos);
    give("depth", "z.exr", {"depth.Z", "R", "G", "B"});
    EXPECT_EQ(channels_of("depth"), ChannelNames{"depth.Z"});
}

TEST_F(RoleFiles, WithOneChannelNeedNoName) {
    sequence_.profile = "native";
    for (const char* name : {"R", "Y", "V", "distance", "linearZ.R"}) {
        give("depth", "z.exr", {name});
        EXPECT_EQ(channels_of("depth"), ChannelNames{name});
    }
}

TEST_F(RoleFiles, MayHaveOneLayerOfAnyName) {
    sequence_.profile = "native";
    give("normal", "n.exr", {"Image.R", "Image.G", "Image.B"});
    EXPECT_EQ(channels_of("normal"), (ChannelNames{"Image.R", "Image.G", "Image.B"}));
    give("normal", "n.exr", {"a.R", "a.G", "a.B", "b.R"});
    EXPECT_NE(refusal().find("\"normal\": {\"channels\": [\"NAME\", \"NAME\", \"NAME\"]}"),
              std::string::npos);
}

TEST_F(RoleFiles, HaveTheChannelsThatTheUserNames) {
    const auto decoding = [](const std::string& name) {
        RoleDecoding named;
        named.layers = {{name}};
        return named;
    };
    sequence_.channels["depth"] = decoding("G");
    EXPECT_EQ(channels_of("depth"), ChannelNames{"G"}) << "of the main file, too";
    give("depth", "aov.exr", {"R", "G", "B", "diffuse.R"});
    EXPECT_EQ(channels_of("depth"), ChannelNames{"G"});
    sequence_.channels["depth"] = decoding("Z");
    const std::string message = refusal();
    EXPECT_NE(message.find("aov.exr: does not have the channels that capture.json names for depth (it has "),
              std::string::npos)
        << message;
}

/// Falcor's depth is planar and +inf where nothing was hit; its normals have the length 1.
TEST(FalcorsPasses, AreReadFromAFileEach) {
    AFTERSHADE_REQUIRE_CAPTURE(color, "producers/falcor/svgf.PathTracer.color.0.exr");
    const std::string folder = color->parent_path().string() + "/svgf.GBufferRT.";
    Sequence sequence = sequence_of(*color, "falcor");
    EXPECT_EQ(CaptureReader(sequence, profiles_as_shipped(), {}).read_header(0).roles, ChannelNames{"color"});
    for (const auto& [role, pass] : std::map<std::string, std::string>{
             {"depth", "linearZ"}, {"velocity", "mvec"}, {"normal", "guideNormalW"}})
        sequence.role_files.insert_or_assign(role, FramePattern(folder + pass + ".0.exr"));
    const Capture capture = CaptureReader(sequence, profiles_as_shipped(), {})
                                .read(0, ChannelNames{"color", "depth", "velocity", "normal"});
    const Image& depth = capture.images.at("depth");
    const Image& normal = capture.images.at("normal");
    std::size_t hits = 0;
    for (int y = 0; y < depth.height(); ++y)
        for (int x = 0; x < depth.width(); ++x) {
            const float z = depth.at(x, y, 0);
            if (std::isinf(z)) continue;
            ++hits;
            ASSERT_GT(z, 0) << x << " " << y;
            const double length = std::hypot(normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2));
            ASSERT_NEAR(length, 1, 0.01) << x << " " << y;
        }
    EXPECT_EQ(hits, 256u * 256u - 42100u) << "as oiiotool --stats counts";
    EXPECT_TRUE(capture.images.contains("velocity"));
}

/// A main file and a depth file of given windows, with the depth 1, 2, 3 ... by rows.
class RoleFileWindows : public testing::Test {
protected:
    void write(const std::string& name, const char* channel, const Window& data, const Window& display) {
        Image image(data.width(), data.height(), 1);
        for (std::size_t i = 0; i < image.floats().size(); ++i) image.floats()[i] = float(i + 1);
        std::vector<ExrOutputChannel> channels{{channel, PixelType::float32, &image, 0}};
        if (std::string(channel) == "R")
            for (const char* other : {"G", "B"}) channels.push_back({other, PixelType::float32, &image, 0});
        ExrWriteOptions options;
        options.data_window = data;
        options.display_window = display;
        write_exr(folder_ / name, channels, options);
    }
    Image depth() const {
        Sequence sequence = sequence_of(folder_ / "color.exr", "native");
        sequence.role_files.insert_or_assign("depth", FramePattern((folder_ / "z.exr").string()));
        const CaptureReader reader(sequence, profiles_as_shipped(), {});
        return reader.read(1, std::vector<std::string>{"depth"}).images.at("depth");
    }
    TemporaryFolder folder_;
};

TEST_F(RoleFileWindows, OfAnotherSizeAreRefusedWithBoth) {
    write("color.exr", "R", {0, 0, 15, 7}, {0, 0, 15, 7});
    write("z.exr", "Z", {0, 0, 7, 3}, {0, 0, 7, 3});
    const std::string message = error_of(ErrorKind::capture, [&] { depth(); });
    EXPECT_NE(
        message.find("z.exr: the role 'depth' has a display window of 8 x 4 px at (0, 0), but that of "),
        std::string::npos)
        << message;
    EXPECT_NE(message.find("color.exr is 16 x 8 px at (0, 0) (render both at one size"), std::string::npos)
        << message;
}

TEST_F(RoleFileWindows, MayHoldAPartOfThePictureThatTheyDeclare) {
    write("color.exr", "R", {0, 0, 15, 7}, {0, 0, 15, 7});
    write("z.exr", "Z", {4, 2, 7, 3}, {0, 0, 15, 7});
    const Image image = depth();
    EXPECT_EQ(image.at(4, 2, 0), 1);
    EXPECT_EQ(image.at(7, 3, 0), 8);
    EXPECT_TRUE(std::isinf(image.at(3, 2, 0))) << "nothing was hit where the file says nothing";
}

TEST_F(RoleFileWindows, MayDifferInTheDisplayWindowAloneWhereTheirPixelsAreTheSame) {
    write("color.exr", "R", {-2, -2, 17, 9}, {0, 0, 15, 7});
    write("z.exr", "Z", {-2, -2, 17, 9}, {-2, -2, 17, 9});
    EXPECT_EQ(depth().at(0, 0, 0), 1);
}

}  // namespace
}  // namespace aftershade::test
