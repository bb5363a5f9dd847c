#include "framework/capture/capture.h"

#include <algorithm>
#include <cmath>

#include "tests/capture/capture_files.h"

namespace aftershade {
namespace {

using test::capture_error;
using test::error_of;

const std::vector<std::string> kSuzanneRoles = {"color",  "depth",  "velocity", "velocity_next", "irradiance",
                                                "albedo", "normal", "position", "object_id"};

/// Frame 4 of scenes/suzanne, a real Blender file.
const Capture& suzanne() {
    static const Capture capture = [] {
        Diagnostics diagnostics;
        const auto sequence =
            open_sequence(AFTERSHADE_SOURCE_DIR "/scenes/suzanne/capture.json", diagnostics);
        const CaptureReader reader(*sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics),
                                   {});
        return reader.read(4, kSuzanneRoles);
    }();
    return capture;
}

TEST(RealCapture, HasTheRolesThatBlenderWrote) {
    const CaptureHeader& header = suzanne().header;
    EXPECT_EQ(header.frame, 4);
    EXPECT_EQ(header.profile, "blender");
    EXPECT_EQ(header.profile_reason, "chosen by name");
    std::vector<std::string> expected = kSuzanneRoles;
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(header.roles, expected);
    EXPECT_EQ(header.channels.size(), 25U);
    EXPECT_EQ(header.data_window, (Window{0, 0, 479, 269}));
    EXPECT_EQ(header.display_window, (Window{0, 0, 479, 269}));
    EXPECT_EQ(header.camera.get("sensor_width"), 36.0);
    for (const std::string& role : kSuzanneRoles) {
        ASSERT_TRUE(suzanne().images.contains(role)) << role;
        EXPECT_EQ(suzanne().images.at(role).width(), 480) << role;
        EXPECT_EQ(suzanne().images.at(role).height(), 270) << role;
    }
}

/// The mean over the ball, object 2.
double mean_over_ball(const Capture& capture, const std::string& role, int channel) {
    const Image& ids = capture.images.at("object_id");
    const Image& image = capture.images.at(role);
    double sum = 0;
    int count = 0;
    for (int y = 0; y < ids.height(); ++y)
        for (int x = 0; x < ids.width(); ++x) {
            if (ids.uint_at(x, y, 0) != 2) continue;
            sum += double(image.at(x, y, channel));
            ++count;
        }
    EXPECT_GT(count, 100);
    return sum / count;
}

// The README of the captures, of 960 px wide frames: mean Vector over the ball is (-55.9, -12.6, -56.2, 0.16)
// while it moves right and up, so velocity = (-X, +Y) and velocity_next = (-Z, +W) with rows down.
TEST(RealCapture, MovesTheBallAsItMovedInTheScene) {
    AFTERSHADE_REQUIRE_CAPTURE(file, "suzanne/large/gbuffer_0004.exr");
    const Sequence sequence = test::sequence_of(*file, "blender");
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    const Capture large = reader.read(4, kSuzanneRoles);
    EXPECT_NEAR(mean_over_ball(large, "velocity", 0), 55.9, 0.05);
    EXPECT_NEAR(mean_over_ball(large, "velocity", 1), -12.6, 0.05);
    EXPECT_NEAR(mean_over_ball(large, "velocity_next", 0), 56.2, 0.05);
    EXPECT_NEAR(mean_over_ball(large, "velocity_next", 1), 0.16, 0.005);
}

// Frames half as wide move half as many pixels; 0.2 px for the ball's edge, which other pixels sample.
TEST(RealCapture, MovesHalfAsManyPixelsAtHalfTheSize) {
    EXPECT_NEAR(mean_over_ball(suzanne(), "velocity", 0), 55.9 / 2, 0.2);
    EXPECT_NEAR(mean_over_ball(suzanne(), "velocity", 1), -12.6 / 2, 0.2);
    EXPECT_NEAR(mean_over_ball(suzanne(), "velocity_next", 0), 56.2 / 2, 0.2);
    EXPECT_NEAR(mean_over_ball(suzanne(), "velocity_next", 1), 0.16 / 2, 0.02);
}

TEST(RealCapture, HasMetresAndInfiniteBackground) {
    const std::vector<std::string> stored_name = {"ViewLayer.Depth.Z"};
    const Image stored = ExrFile(suzanne().header.path).read_floats(0, stored_name);
    const Image& depth = suzanne().images.at("depth");
    std::size_t nothing_hit = 0;
    for (std::size_t i = 0; i < depth.floats().size(); ++i) {
        const float metres = depth.floats()[i];
        if (stored.floats()[i] == 1e10f) {
            EXPECT_TRUE(std::isinf(metres) && metres > 0);
            ++nothing_hit;
        } else {
            EXPECT_EQ(metres, stored.floats()[i]);
        }
    }
    EXPECT_GT(nothing_hit, 0U);
    EXPECT_NEAR(depth.at(240, 135, 0), 6.670722f,
                1e-6f);  // oiiotool --printstats of that pixel, as all below
    EXPECT_NEAR(depth.at(300, 120, 0), 7.686023f, 1e-6f);
}

TEST(RealCapture, AddsDirectAndIndirectLight) {
    EXPECT_NEAR(suzanne().images.at("irradiance").at(240, 135, 0), 0.816895f + 0.126099f, 1e-6f);
    EXPECT_NEAR(suzanne().images.at("irradiance").at(300, 120, 0), 0.560059f + 0.279297f, 1e-6f);
    EXPECT_NEAR(suzanne().images.at("color").at(240, 135, 1), 0.497314f, 1e-6f);
}

TEST(RealCapture, NumbersItsObjects) {
    const Image& ids = suzanne().images.at("object_id");
    ASSERT_EQ(ids.type(), ComponentType::uint32);
    EXPECT_EQ(ids.uint_at(240, 135, 0), 1U);
    for (const std::uint32_t object : {0U, 1U, 2U, 3U})  // nothing, head, ball, cube
        EXPECT_NE(std::find(ids.uints().begin(), ids.uints().end(), object), ids.uints().end()) << object;
}

class CaptureFile : public ::testing::Test {
protected:
    CaptureFile() {
        test::write_channels(folder_ / "f_0001.exr", 2,
                             {{"R", {1, 2}}, {"G", {3, 4}}, {"B", {5, 6}}, {"Z", {7, 8}}},
                             {{"artist", std::string("someone")}});
        sequence_ = test::sequence_of(folder_ / "f_####.exr", "auto");
    }
    CaptureReader reader() const {
        return CaptureReader(sequence_, {test::profile_of_roles(R"("depth": {"channels": ["Z"]},
            "velocity": {"channels": ["u", "v"]})")},
                             limits_);
    }

    const test::TemporaryFolder folder_;
    Sequence sequence_;
    ReadLimits limits_;
};

TEST_F(CaptureFile, SaysWhatItHasBeforeItsPixelsAreRead) {
    const CaptureHeader header = reader().read_header(1);
    EXPECT_EQ(header.roles, (std::vector<std::string>{"color", "depth"}));
    EXPECT_EQ(header.channels, (std::vector<std::string>{"B", "G", "R", "Z"}));
    EXPECT_EQ(header.profile, "t");
    EXPECT_TRUE(header.profile_reason.starts_with("channel ")) << header.profile_reason;
    EXPECT_EQ(header.metadata.text("artist"), "someone");
    EXPECT_EQ(header.path, folder_ / "f_0001.exr");
}

TEST_F(CaptureFile, LeavesOutRolesThatItLacks) {
    const std::vector<std::string> wanted = {"color", "depth", "velocity", "albedo"};
    const Capture capture = reader().read(1, wanted);
    ASSERT_EQ(capture.images.size(), 2U);
    EXPECT_EQ(capture.images.at("depth").at(1, 0, 0), 8.0f);
    EXPECT_EQ(capture.images.at("color").at(0, 0, 2), 5.0f);
    EXPECT_EQ(capture.images.at("color").at(0, 0, 3), 1.0f);
}

TEST_F(CaptureFile, ThatCannotBeReadIsACaptureErrorWithItsPath) {
    EXPECT_TRUE(
        capture_error([&] { reader().read_header(2); }).starts_with((folder_ / "f_0002.exr").string()));
    test::write_text(folder_ / "f_0003.exr", "not an image");
    EXPECT_TRUE(
        capture_error([&] { reader().read_header(3); }).starts_with((folder_ / "f_0003.exr").string()));
    limits_.max_side_px = 1;
    EXPECT_TRUE(
        capture_error([&] { reader().read_header(1); }).starts_with((folder_ / "f_0001.exr").string()));
}

TEST_F(CaptureFile, WithAnUnknownProfileNamesThoseThereAre) {
    sequence_.profile = "blendr";
    EXPECT_EQ(error_of(ErrorKind::usage, [&] { reader().read_header(1); }),
              "no profile 'blendr'; known: 't'");
}

}  // namespace
}  // namespace aftershade
