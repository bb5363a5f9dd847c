// The check of motion vectors through the public API: what the program prints, and vectors that are wrong.
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "aftershade/host.h"
#include "tests/host/host_setup.h"
#include "tests/temporary_folder.h"

namespace {

using namespace aftershade::host;
using namespace aftershade::test;

const std::string kFrame = std::string(AFTERSHADE_SOURCE_DIR) + "/scenes/suzanne/gbuffer_0003.exr";
const std::string kNextFrame = std::string(AFTERSHADE_SOURCE_DIR) + "/scenes/suzanne/gbuffer_0004.exr";

TEST(HostVelocity, IsWhatTheProgramPrints) {
    const TemporaryFolder folder;
    const std::string printed = folder.path() / "printed.json";
    std::system(("\"" AFTERSHADE_EXECUTABLE "\" inspect --json --check-velocity " + kFrame + " " +
                 kNextFrame + " > " + printed)
                    .c_str());
    const auto expected = nlohmann::json::parse(std::ifstream(printed)).at("checks");
    const Host host(on_software());
    const std::vector<VelocityCheck> checks = check_velocity(host, kFrame, kNextFrame);
    ASSERT_FALSE(checks.empty());
    ASSERT_EQ(checks.size(), expected.size());
    for (std::size_t i = 0; i < checks.size(); ++i) {
        EXPECT_EQ(checks[i].role, expected[i].at("role").get<std::string>());
        EXPECT_EQ(velocity_verdict_name(checks[i].verdict), expected[i].at("verdict").get<std::string>());
        EXPECT_EQ(checks[i].sentence, expected[i].at("sentence").get<std::string>());
        EXPECT_EQ(checks[i].score, expected[i].at("score"));
        EXPECT_EQ(checks[i].settings.delta, expected[i].at("settings").at("delta").get<std::string>());
        EXPECT_EQ(checks[i].suggested.delta, expected[i].at("suggested").at("delta").get<std::string>());
    }
}

/// Both frames, with the vectors of each multiplied.
std::vector<VelocityCheck> check_scaled(const Host& host, float scale_x, float scale_y) {
    std::vector<Capture> frames = {Capture::read(host, kFrame), Capture::read(host, kNextFrame)};
    for (Capture& frame : frames)
        for (const char* role : {"velocity", "velocity_next"}) {
            if (!frame.has_image(role)) continue;
            const Image image = frame.image(role);
            std::vector<float> changed(image.floats().begin(), image.floats().end());
            for (std::size_t i = 0; i + 1 < changed.size(); i += 2)
                changed[i] *= scale_x, changed[i + 1] *= scale_y;
            frame.set_image(role, view_of(changed, image.width(), image.height(), 2));
        }
    return check_velocity(frames[0], frames[1]);
}

TEST(HostVelocity, OfFramesInMemoryTellsAWrongSign) {
    const Host host(on_software());
    const auto right = check_scaled(host, 1, 1), reversed = check_scaled(host, -1, -1);
    ASSERT_FALSE(right.empty());
    ASSERT_EQ(right.size(), reversed.size());
    EXPECT_NE(right[0].verdict, VelocityVerdict::wrong) << right[0].sentence;
    EXPECT_EQ(right[0].suggested.delta, right[0].settings.delta);
    EXPECT_EQ(reversed[0].verdict, VelocityVerdict::wrong) << reversed[0].sentence;
    EXPECT_EQ(reversed[0].settings.delta, "cur-prev");
    EXPECT_EQ(reversed[0].suggested.delta, "prev-cur");
    EXPECT_GT(right[0].score, reversed[0].score);
}

TEST(HostVelocity, NeedsColorAndMotionInMemory) {
    EXPECT_TRUE(check_velocity(small_capture(), small_capture()).empty()) << "no motion";
    Capture without = small_capture();
    without.remove_image("color");
    try {
        check_velocity(small_capture(), without);
        ADD_FAILURE() << "a frame without color was compared";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        EXPECT_NE(std::string(error.what()).find("the second frame: has no color"), std::string::npos)
            << error.what();
    }
}

}  // namespace
