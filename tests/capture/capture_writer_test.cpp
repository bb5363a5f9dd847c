// Captures written under each producer's conventions and read back by the readers that real files are read
// with.
#include "framework/capture/capture_writer.h"

#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "framework/image/role.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;

/// The waves below are no surfaces, so a repair of averages would change them: sample_means_test.cpp has
/// that.
std::vector<Profile> profiles_without_repair() {
    Diagnostics diagnostics;
    auto profiles = read_profiles(fs::path(AFTERSHADE_SOURCE_DIR) / "profiles", diagnostics);
    for (Profile& profile : profiles)
        for (auto& [role, decoding] : profile.roles) decoding.is_mean = false;
    return profiles;
}

constexpr int kWidth = 23, kHeight = 17;

float formula(const std::string& role, int x, int y, int c) {
    const float wave = std::sin(0.7f * float(x) + 1.3f * float(y) + 2.1f * float(c));
    if (role == "depth")
        return (x + y) % 11 == 0 ? std::numeric_limits<float>::infinity() : 2 + 30 * (wave + 1);
    if (role.starts_with("velocity"))
        return 9 * wave;  // Unity marks what crosses half the picture as no motion
    if (role == "position" || role == "normal") return wave;
    return c == 3 ? 1 : 3 * (wave + 1);
}

Capture make_capture() {
    Capture capture;
    CaptureHeader& header = capture.header;
    header.data_window = header.display_window = {0, 0, kWidth - 1, kHeight - 1};
    for (const char* name : {"color", "depth", "velocity", "velocity_next", "irradiance", "albedo",
                             "specular", "emission", "normal", "position"}) {
        Image image(kWidth, kHeight, find_role(name)->channels);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < image.channels(); ++c) image.at(x, y, c) = formula(name, x, y, c);
        capture.images[name] = std::move(image);
    }
    Image ids(kWidth, kHeight, 1, ComponentType::uint32);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) ids.uint_at(x, y, 0) = std::uint32_t(x * 100 + y);
    capture.images["object_id"] = std::move(ids);
    Camera& camera = header.camera;
    camera.set("focal_length", 36);
    camera.set("sensor_width", 36);
    camera.set("focus_distance", 4.5);
    camera.set("f_number", 2.5);
    camera.set("blades", 6);
    camera.set("near", 0.5);  // where z-buffers and normalised depths lie
    camera.set("far", 100);
    camera.set_lens_model("pinhole", "");
    camera.jitter_px = {0.25, -0.375};
    camera.camera_from_world = {1, 0, 0, -1, 0, 1, 0, -2, 0, 0, 1, -5, 0, 0, 0, 1};
    camera.ndc_from_world = {2, 0, 0, -2, 0, 3, 0, -6, 0, 0, -1, 4.99, 0, 0, -1, 5};
    header.lights = {{CaptureLight::Kind::point, "key", {1, 2, 3}, {}, {}, {4, 5, 6}}};
    return capture;
}

class EveryProfile : public testing::TestWithParam<std::string> {
protected:
    const Profile& profile() {
        for (const Profile& one : profiles_)
            if (one.id == GetParam()) return one;
        throw std::runtime_error("no such profile");
    }
    std::vector<Profile> profiles_ = profiles_without_repair();
    test::TemporaryFolder folder_;
};

TEST_P(EveryProfile, IsReadBackToWhatWasWritten) {
    const Capture capture = make_capture();
    const fs::path path = folder_ / "frame_0007.exr";
    CaptureWriteOptions options;
    options.fps = 24000.0 / 1001;
    const auto left_out = write_capture(path, capture, profile(), options);
    Diagnostics diagnostics;
    auto sequence = open_sequence(path.string(), diagnostics);
    ASSERT_TRUE(sequence);
    sequence->profile = GetParam();
    const CaptureReader reader(*sequence, profiles_, {});
    std::vector<RoleId> roles;
    for (const auto& [role, image] : capture.images) roles.push_back(role);
    const Capture back = reader.read(7, roles);
    EXPECT_EQ(back.images.size() + left_out.size(), capture.images.size());
    ASSERT_TRUE(back.images.contains("color"));
    for (const auto& [role, image] : back.images) {
        const Image& original = capture.images.at(role);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                if (image.type() == ComponentType::uint32) {
                    ASSERT_EQ(image.uint_at(x, y, 0), original.uint_at(x, y, 0)) << role.name();
                    continue;
                }
                for (int c = 0; c < image.channels(); ++c) {
                    const float expected = original.at(x, y, c), found = image.at(x, y, c);
                    if (std::isinf(expected)) ASSERT_EQ(found, expected) << role.name();
                    else if (role == "depth")
                        ASSERT_NEAR(found, expected, 2e-5 * expected) << role.name() << " " << x << " " << y;
                    else if (role.name().starts_with("velocity"))
                        ASSERT_NEAR(found, expected, 1e-3) << role.name();
                    // Of some profiles light times albedo, and back.
                    else if (role == "irradiance")
                        ASSERT_NEAR(found, expected, 1e-6 * expected) << role.name();
                    else ASSERT_EQ(found, expected) << role.name();
                }
            }
    }
    const Camera& camera = back.header.camera;
    EXPECT_EQ(camera.get("focus_distance"), 4.5);
    EXPECT_EQ(camera.get("blades"), 6);
    EXPECT_NEAR(back.header.metadata.number("framesPerSecond").value_or(0), 24000.0 / 1001, 1e-9);
    EXPECT_EQ(camera.lens_model, "pinhole");
    ASSERT_TRUE(camera.jitter_px);
    EXPECT_EQ(*camera.jitter_px, (std::array<double, 2>{0.25, -0.375}));
    ASSERT_TRUE(camera.camera_from_world && camera.ndc_from_world);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_FLOAT_EQ(float((*camera.ndc_from_world)[i]),
                        float((*capture.header.camera.ndc_from_world)[i]));
    EXPECT_EQ(back.header.lights, capture.header.lights);
}

TEST_P(EveryProfile, IsDetectedFromWhatWasWritten) {
    // Its vectors differ from unreal's by a factor of two and nothing else: a file cannot tell.
    if (GetParam() == "unreal_half_screen") GTEST_SKIP() << "looks like unreal; is chosen by name";
    if (GetParam() != "native" && profile().detect_attributes.empty() && profile().detect_channels.empty())
        GTEST_SKIP() << "has no mark of its own; is chosen by name";
    if (GetParam() == "clarisse") GTEST_SKIP() << "detected by its Cryptomattes, which are not written";
    const fs::path path = folder_ / "frame_0007.exr";
    write_capture(path, make_capture(), profile(), {});
    const ExrFile file(path);
    EXPECT_EQ(detect_profile(profiles_, file.parts().front(), "frame").profile->id, GetParam());
}

std::vector<std::string> profile_ids() {
    std::vector<std::string> ids;
    for (const Profile& profile : profiles_without_repair()) ids.push_back(profile.id);
    return ids;
}
INSTANTIATE_TEST_SUITE_P(Shipped, EveryProfile, testing::ValuesIn(profile_ids()),
                         [](const auto& id) { return id.param; });

TEST(CaptureWriter, UsesTheNamesAndUnitsOfTheProducer) {
    test::TemporaryFolder folder;
    for (const Profile& profile : profiles_without_repair())
        write_capture(folder / (profile.id + ".exr"), make_capture(), profile, {});
    const auto value = [&](const char* file, const char* channel, int x, int y) {
        const std::vector<std::string> one = {channel};
        return ExrFile(folder / file).read_floats(0, one).at(x, y, 0);
    };
    const float vx = formula("velocity", 3, 2, 0), vy = formula("velocity", 3, 2, 1);
    // Blender's Vector: previous minus current with rows upwards, so that Y keeps its sign.
    EXPECT_FLOAT_EQ(value("blender.exr", "ViewLayer.Vector.X", 3, 2), -vx);
    EXPECT_FLOAT_EQ(value("blender.exr", "ViewLayer.Vector.Y", 3, 2), vy);
    // Unreal: half the screen is 0.5, centimetres.
    EXPECT_NEAR(value("unreal.exr", "FinalImageMovieRenderQueue_MotionVectors.R", 3, 2), 0.5 + vx / kWidth,
                1e-6);
    EXPECT_FLOAT_EQ(value("unreal.exr", "FinalImageMovieRenderQueue_WorldDepth.R", 3, 2),
                    100 * formula("depth", 3, 2, 0));
    // Nuke: backward is previous minus current, rows upwards.
    EXPECT_FLOAT_EQ(value("nuke.exr", "backward.u", 3, 2), -vx);
    EXPECT_FLOAT_EQ(value("nuke.exr", "backward.v", 3, 2), vy);
}

TEST(CaptureWriter, RefusesIdsThatTheProducersFloatsCannotHold) {
    test::TemporaryFolder folder;
    Capture capture = make_capture();
    capture.images.at("object_id").uint_at(5, 5, 0) = 16777217;
    for (const Profile& profile : profiles_without_repair()) {
        if (profile.id == "native") {
            EXPECT_NO_THROW(write_capture(folder / "native.exr", capture, profile, {}));
        }
        if (profile.id != "blender") continue;
        try {
            write_capture(folder / "blender.exr", capture, profile, {});
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::output);
            EXPECT_NE(std::string(error.what()).find("object id 16777217"), std::string::npos)
                << error.what();
        }
    }
}

TEST(CaptureDocument, IsReadBackAsTheSequenceThatItDescribes) {
    test::TemporaryFolder folder;
    CaptureDocument document;
    document.frame_numbers = {1, 2, 3, 5};
    document.fps = 30;
    document.camera = {{"focal_length", 50}, {"f_number", 2.8}};
    document.lens_model = "pinhole";
    document.lights = make_capture().header.lights;
    document.cuts = {3};
    document.subframes = 4;
    write_capture_document(folder / "capture.json", document);
    Diagnostics diagnostics;
    // The folder stands for its document.
    const auto sequence = open_sequence(folder.path().string(), diagnostics);
    ASSERT_TRUE(sequence && !diagnostics.has_errors());
    EXPECT_EQ(sequence->frames, document.frame_numbers);
    EXPECT_EQ(sequence->fps, 30);
    EXPECT_EQ(sequence->profile, "native");
    EXPECT_EQ(sequence->camera.get("f_number"), 2.8);
    EXPECT_EQ(sequence->camera.lens_model, "pinhole");
    EXPECT_EQ(sequence->lights, document.lights);
    EXPECT_EQ(sequence->cuts, document.cuts);
    EXPECT_EQ(sequence->subframes, 4);
    EXPECT_EQ(sequence->path_of(sequence->file_number(5, 2)).filename(), "gbuffer_0022.exr");
}

TEST(CaptureReader, TellsWhereTheLightsOfAFileAreDamaged) {
    test::TemporaryFolder folder;
    CaptureWriteOptions options;
    Capture capture = make_capture();
    capture.header.lights.clear();
    options.attributes["aftershade/lights"] = std::string(R"([ { "type": "point" } ])");
    const auto profiles = profiles_without_repair();
    const fs::path path = folder / "frame_0001.exr";
    for (const Profile& profile : profiles)
        if (profile.id == "native") write_capture(path, capture, profile, options);
    Diagnostics diagnostics;
    const auto sequence = open_sequence(path.string(), diagnostics);
    const CaptureReader reader(*sequence, profiles, {});
    try {
        reader.read_header(1);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::capture);
        EXPECT_NE(std::string(error.what()).find("attribute aftershade/lights:1:"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace aftershade
