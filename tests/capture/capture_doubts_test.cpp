// Files whose names, numbers or camera leave open what they mean: a warning with the way to say it.
#include <gtest/gtest.h>

#include <cmath>

#include "framework/capture/camera_metadata.h"
#include "framework/image/camera_matrix.h"
#include "tests/camera_pose.h"
#include "tests/capture/capture_files.h"
#include "tests/capture/part_files.h"

namespace aftershade::test {
namespace {

using Names = std::vector<std::string>;
using Attributes = std::map<std::string, ExrValue>;

const std::vector<Profile>& shipped() {
    static const std::vector<Profile> profiles = [] {
        Diagnostics diagnostics;
        return read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    }();
    return profiles;
}

std::string joined_lines(const Names& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

/// What is said of a file of 2 x 2 px without a producer's mark, as one of its roles is read.
std::string said_of(std::vector<StoredChannel> channels, const std::string& role,
                    const Attributes& attributes = {},
                    const std::map<std::string, RoleDecoding>& declared = {}, bool has_color = true) {
    const TemporaryFolder folder;
    if (has_color)
        for (const char* name : {"R", "G", "B"}) channels.push_back({name, {1, 2, 3, 4}});
    write_channels(folder / "f.exr", 2, channels, attributes);
    Sequence sequence = sequence_of(folder / "f.exr", "auto");
    sequence.channels = declared;
    const Names asked = {role};
    return joined_lines(CaptureReader(sequence, shipped(), {}).read(1, asked).header.warnings);
}

const std::vector<float> kNear = {2, 3, 4, 5}, kFar = {20, 30, 40, 50};

TEST(Contradiction, OfChannelsUnderOneRolesNamesIsAWarningWhereTheyDiffer) {
    const std::string said = said_of({{"Z", kNear}, {"depth.Z", kFar}, {"ViewLayer.Depth.Z", kFar}}, "depth");
    EXPECT_NE(
        said.find("depth is read from 'Z', and 'depth.Z' and 'ViewLayer.Depth.Z' go by its name and hold "
                  "other values (say which is meant: \"channels\": {\"depth\": {\"channels\": [\"Z\"]}}"),
        std::string::npos)
        << said;
    EXPECT_EQ(said_of({{"Z", kNear}, {"depth.Z", kNear}}, "depth"), "") << "copies";
    EXPECT_EQ(said_of({{"Z", {2, 3, 4, 1e10f}}, {"depth.Z", {2.001f, 3, 4, INFINITY}}}, "depth"), "")
        << "a copy as half";
    EXPECT_NE(said_of({{"Z", kNear}, {"z", kFar}}, "depth"), "") << "in another spelling";
    EXPECT_NE(said_of({{"N.X", kNear},
                       {"N.Y", kNear},
                       {"N.Z", kNear},
                       {"normal.X", kFar},
                       {"normal.Y", kNear},
                       {"normal.Z", kNear}},
                      "normal")
                  .find("normal is read from 'normal.X', and 'N.X' goes by its name"),
              std::string::npos);
    EXPECT_NE(said_of({{"object_id.I", {1, 2, 3, 4}}, {"objectId", {1, 2, 3, 5}}}, "object_id"), "");
    EXPECT_NE(said_of({{"beauty.R", kNear}, {"beauty.G", kNear}, {"beauty.B", kNear}}, "color"), "");
}

TEST(Contradiction, OfChannelsIsNotSaidWhereADocumentDecides) {
    const std::vector<StoredChannel> both = {{"Z", kNear}, {"depth.Z", kFar}};
    RoleDecoding declared;
    declared.layers = {{"depth.Z"}};
    EXPECT_EQ(said_of(both, "depth", {}, {{"depth", declared}}), "");
    EXPECT_EQ(said_of(both, "depth", {{"aftershade/channels", std::string("native")}}), "");
    EXPECT_EQ(said_of({{"V.Combined.R", kNear},
                       {"V.Combined.G", kNear},
                       {"V.Combined.B", kNear},
                       {"V.Depth.Z", kNear},
                       {"Z", kFar},
                       {"V.Mist.Z", kFar}},
                      "depth", {}, {}, false),
              "")
        << "Blender's own names";
    EXPECT_EQ(
        said_of({{"Z", kNear}, {"sky.R", kNear}, {"sky.G", kNear}, {"sky.B", kNear}, {"sky.depth.Z", kFar}},
                "depth"),
        "")
        << "another picture's";
}

TEST(Contradiction, OfADepthThatMayBeNormalizedIsAWarning) {
    const std::vector<StoredChannel> depth = {{"Z", {0.25f, 0.5f, 1, 0}}};
    const std::string said = said_of(depth, "depth");
    EXPECT_NE(said.find("depth is read from 'Z' as metres, and lies between 0 and 1 everywhere"),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("\"encoding\""), std::string::npos) << said;
    EXPECT_EQ(said_of({{"Z", {0.25f, 0.5f, 1.5f, 0}}}, "depth"), "");
    EXPECT_EQ(said_of({{"Z", {1, 1, 1, 1}}}, "depth"), "") << "a card at one metre";
    RoleDecoding metres;
    metres.layers = {{"Z"}};
    EXPECT_EQ(said_of(depth, "depth", {}, {{"depth", metres}}), "");
    EXPECT_EQ(said_of(depth, "depth", {{"aftershade/camera/far", 1.0f}}), "") << "a scene of one metre";
}

TEST(Contradiction, OfADepthBelowAMetreIsNoneWherePositionsHaveItsUnit) {
    const auto with_positions = [](float scale) {
        // Depth is (2 x + 2 y + z) / 3 + 0.25: along an axis that is 1 long.
        const std::vector<float> x = {0, 0.3f, 0, 0}, y = {0, 0, 0.3f, 0}, z = {0, 0, 0, 0.6f};
        std::vector<StoredChannel> channels = {{"P.X", x}, {"P.Y", y}, {"P.Z", z}, {"Z", {}}};
        for (std::size_t i = 0; i < 4; ++i)
            channels[3].values.push_back(scale * (2 * x[i] + 2 * y[i] + z[i]) / 3 + 0.25f);
        return said_of(channels, "depth");
    };
    EXPECT_EQ(with_positions(1), "");
    EXPECT_NE(with_positions(0.5f), "");
}

std::vector<float> stored_matrix_of(const CameraMatrix& rows) {
    std::vector<float> stored(16);
    for (std::size_t i = 0; i < 16; ++i) stored[i % 4 * 4 + i / 4] = float(rows[i]);
    return stored;
}

/// A camera whose matrices show `focal_length` over a sensor of 36 mm.
Attributes matrices_of(double focal_length_mm) {
    CameraPose pose;
    pose.position_m = {1, 2, 3};
    pose.angles_deg = {10, 20, 0};
    pose.focal_length_mm = focal_length_mm;
    Camera camera;
    set_pose(camera, pose, 2, 2);
    return {{"worldToCamera", stored_matrix_of(*camera.camera_from_world)},
            {"worldToNDC", stored_matrix_of(*camera.ndc_from_world)}};
}

struct ReadCamera {
    Camera camera;
    std::string faults;
};

ReadCamera read_camera_with(Attributes attributes, const Attributes& more, const Camera& known = {}) {
    const TemporaryFolder folder;
    for (const auto& [name, value] : more) attributes[name] = value;
    write_channels(folder / "f.exr", 2, {{"R", kNear}}, attributes);
    const ExrFile file(folder / "f.exr");
    const Profile profile = profile_of_roles("");
    return {camera_of_metadata(file.parts()[0], profile, known),
            joined_lines(camera_faults(file.parts()[0], profile, known))};
}

TEST(Contradiction, OfALensAndAProjectionIsAWarningAndTheProjectionIsTaken) {
    const Attributes lens = {{"nominalFocalLength", 36.0f}, {"aftershade/camera/sensor_width", 36.0f}};
    EXPECT_EQ(read_camera_with(matrices_of(36.2), lens).faults, "") << "rounded";
    const ReadCamera other = read_camera_with(matrices_of(20), lens);
    EXPECT_NE(other.faults.find("focal_length 36 mm and sensor_width 36 mm, shows 53.1 degrees, and the "
                                "header's projection 84, which is taken"),
              std::string::npos)
        << other.faults;
    EXPECT_NEAR(other.camera.get("sensor_width").value_or(0), 64.8, 0.01);
    EXPECT_EQ(other.camera.get("focal_length"), 36.0);
    Camera known;
    known.set("sensor_width", 24, "capture.json");
    EXPECT_NEAR(read_camera_with(matrices_of(20), lens, known).camera.get("focal_length").value_or(0), 13.333,
                0.01);
    known.set("focal_length", 36, "capture.json");
    EXPECT_EQ(read_camera_with(matrices_of(20), lens, known).faults, "") << "the user's word";
}

TEST(Contradiction, OfTwoFocalLengthsIsAWarningAndTheEffectiveOneIsTaken) {
    const auto both = [](float nominal) {
        return read_camera_with({}, {{"nominalFocalLength", nominal}, {"effectiveFocalLength", 48.0f}});
    };
    EXPECT_EQ(both(48.2f).faults, "");
    EXPECT_NE(both(50).faults.find("effectiveFocalLength gives the camera's focal_length as 48 mm, "
                                   "nominalFocalLength as 50 mm; the first is taken"),
              std::string::npos)
        << both(50).faults;
    EXPECT_EQ(both(50).camera.get("focal_length"), 48.0);
}

TEST(Contradiction, OfMatricesThatAreNoneIsAWarningAndNeitherIsUsed) {
    for (const bool is_own : {false, true})
        for (const char* name : {"worldToCamera", "worldToNDC"})
            for (const float value : {0.0f, std::nanf(""), 1.0f}) {
                Attributes attributes = matrices_of(36);
                if (is_own) attributes["aftershade/matrices"] = 2;
                attributes[name] = std::vector<float>(16, value);
                const ReadCamera read = read_camera_with(attributes, {});
                EXPECT_NE(read.faults.find(name), std::string::npos)
                    << is_own << name << value << read.faults;
                const bool is_view = name == std::string("worldToCamera");
                EXPECT_FALSE(is_view ? read.camera.camera_from_world : read.camera.ndc_from_world)
                    << is_own << name << value;
            }
}

TEST(Contradiction, OfARolesFileOfAnotherCameraOrPictureIsAWarning) {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, const std::string& channel, const Attributes& attributes) {
        std::vector<StoredChannel> channels = {{channel, kNear}};
        if (channel == "R") channels.push_back({"G", kNear}), channels.push_back({"B", kNear});
        write_channels(folder / name, 2, channels, attributes);
    };
    Sequence sequence = sequence_of(folder / "f.exr", "t");
    sequence.role_files.insert_or_assign("depth", FramePattern((folder / "z.exr").string()));
    const auto warnings = [&] {
        const Profile profile = profile_of_roles(R"("depth": {"channels": ["Z"]})");
        return joined_lines(CaptureReader(sequence, {profile}, {}).read_header(1).warnings);
    };
    write("f.exr", "R", matrices_of(36));
    write("z.exr", "Z", matrices_of(36));
    EXPECT_EQ(warnings(), "");
    Attributes moved = matrices_of(36);
    std::get<std::vector<float>>(moved["worldToCamera"])[12] += 0.065f;  // the other eye
    write("z.exr", "Z", moved);
    EXPECT_NE(warnings().find("depth is read from a file whose worldToCamera is another than that of color"),
              std::string::npos)
        << warnings();
    const Imath::Box2i window({0, 0}, {15, 7});
    write_parts(folder / "f.exr", {{"rgb", "left", {"R", "G", "B"}, window, 1}});
    write_parts(folder / "z.exr", {{"z", "right", {"Z"}, window, 2}});
    EXPECT_NE(warnings().find("depth is read from a file in the view 'right', color in 'left'"),
              std::string::npos)
        << warnings();
    const Image values(2, 2, 1);
    const auto write_display = [&](const char* name, const Names& names, const Window& display) {
        std::vector<ExrOutputChannel> channels;
        for (const std::string& channel : names)
            channels.push_back({channel, PixelType::float32, &values, 0});
        ExrWriteOptions options;
        options.data_window = {0, 0, 1, 1};
        options.display_window = display;
        write_exr(folder / name, channels, options);
    };
    write_display("f.exr", {"R", "G", "B"}, {0, 0, 3, 1});
    write_display("z.exr", {"Z"}, {0, 0, 1, 1});
    EXPECT_NE(warnings().find("with a display window of 2 x 2 px at (0, 0), color from one of 4 x 2 px"),
              std::string::npos)
        << warnings();
}

}  // namespace
}  // namespace aftershade::test
