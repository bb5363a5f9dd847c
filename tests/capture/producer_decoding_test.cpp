// The decodings of producers of whom no real file is here, against their documented formulas, and the way
// back.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "framework/capture/decode.h"
#include "framework/image/role.h"
#include "tests/file/image_files.h"
#include "tests/not_finite.h"

namespace aftershade::test {
namespace {

const Window kFullHd{0, 0, 1919, 1079};

const Profile& profile(const std::string& id) {
    static const std::vector<Profile> profiles = [] {
        Diagnostics diagnostics;
        return read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    }();
    for (const Profile& candidate : profiles)
        if (candidate.id == id) return candidate;
    throw std::runtime_error("no profile " + id);
}

DecodeContext context() {
    DecodeContext result;
    result.file = "test";
    result.grid = result.display = kFullHd;
    return result;
}

struct Vector {
    float x = 0, y = 0;
};

Image two_pixels(Vector first, Vector second = {}) {
    Image image(2, 1, 2);
    image.at(0, 0, 0) = first.x, image.at(0, 0, 1) = first.y;
    image.at(1, 0, 0) = second.x, image.at(1, 0, 1) = second.y;
    return image;
}

struct VelocityCase {
    const char* profile;
    const char* role;
    Vector stored;
    Vector decoded;  ///< px of a 1920 x 1080 frame, +y down
};

/// Each row by hand from the producer's own formula, as profiles/<id>.json names it.
const VelocityCase kVelocity[] = {
    {"native", "velocity", {3, -4}, {3, -4}},
    {"blender", "velocity", {-55.9f, -12.6f}, {55.9f, -12.6f}},
    {"blender", "velocity_next", {-56.2f, 0.16f}, {56.2f, 0.16f}},
    // (R - 0.5) * width, (G - 0.5) * height, rows up
    {"unreal", "velocity", {0.51f, 0.52f}, {19.2f, -21.6f}},
    // (R - 0.5) * 2 * width * -1, (G - 0.5) * 2 * height
    {"unreal_half_screen", "velocity", {0.51f, 0.52f}, {-38.4f, 43.2f}},
    {"unity", "velocity", {0.01f, 0.02f}, {19.2f, -21.6f}},
    {"nuke", "velocity_next", {5, 7}, {5, -7}},
    {"nuke", "velocity", {5, 7}, {-5, 7}},
    // -mvec * (width, height)
    {"falcor", "velocity", {0.01f, 0.02f}, {-19.2f, -21.6f}},
    // uv + velocity is where the pixel was, uv (0, 0) top left
    {"godot", "velocity", {0.01f, 0.02f}, {-19.2f, -21.6f}},
    {"arnold", "velocity_next", {2, 3}, {2, -3}},
    // -1 to +1 across the width
    {"moonray", "velocity_next", {0.02f, 0.02f}, {19.2f, -10.8f}},
};

TEST(ProducerVelocity, IsDecodedByItsFormulaAndEncodedBack) {
    for (const VelocityCase& c : kVelocity) {
        const RoleDecoding& decoding = profile(c.profile).roles.at(c.role);
        Image image = two_pixels(c.stored);
        EXPECT_TRUE(decode_velocity(image, decoding, context()).empty()) << c.profile;
        EXPECT_NEAR(image.at(0, 0, 0), c.decoded.x, 2e-3) << c.profile << " " << c.role;
        EXPECT_NEAR(image.at(0, 0, 1), c.decoded.y, 2e-3) << c.profile << " " << c.role;
        encode_velocity(image, decoding, context());
        EXPECT_NEAR(image.at(0, 0, 0), c.stored.x, 1e-6 * (1 + std::abs(c.stored.x))) << c.profile;
        EXPECT_NEAR(image.at(0, 0, 1), c.stored.y, 1e-6 * (1 + std::abs(c.stored.y))) << c.profile;
    }
}

TEST(ProducerVelocity, OfUnityMarksPixelsWithoutMotionByAnXAboveOne) {
    Image image = two_pixels({2, 0}, {0.01f, 0});
    const auto missing = decode_velocity(image, profile("unity").roles.at("velocity"), context());
    EXPECT_EQ(missing, std::vector<std::size_t>{0});
    EXPECT_EQ(image.at(0, 0, 0), 0);
    EXPECT_NEAR(image.at(1, 0, 0), 19.2f, 1e-3);
}

TEST(ProducerVelocity, OfGodotMarksPixelsWithoutMotionByMinusOne) {
    Image image = two_pixels({-1, -1}, {-0.5f, 0});
    const auto missing = decode_velocity(image, profile("godot").roles.at("velocity"), context());
    EXPECT_EQ(missing, std::vector<std::size_t>{0});
    EXPECT_EQ(image.at(0, 0, 0), 0);
    EXPECT_NEAR(image.at(1, 0, 0), 960, 1e-3);
}

TEST(ProducerVelocity, OfMoonrayIsDividedByAlpha) {
    Image color(2, 1, 4);
    color.at(0, 0, 3) = 0.5f;  // the second pixel has none, and its vector is what it is
    DecodeContext with_color = context();
    with_color.color = &color;
    Image image = two_pixels({0.01f, 0}, {0.01f, 0});
    decode_velocity(image, profile("moonray").roles.at("velocity_next"), with_color);
    EXPECT_NEAR(image.at(0, 0, 0), 19.2f, 1e-3);
    EXPECT_NEAR(image.at(1, 0, 0), 9.6f, 1e-3);
}

TEST(ProducerVelocity, SpansAsManyFramesAsTheShutterSays) {
    RoleDecoding decoding = profile("arnold").roles.at("velocity_next");
    decoding.shutter_frames = 0.5;  // half a frame's motion is stored
    Image image = two_pixels({2, 3});
    decode_velocity(image, decoding, context());
    EXPECT_NEAR(image.at(0, 0, 0), 4, 1e-6);
}

Image depth_of(std::initializer_list<float> values) {
    Image image(int(values.size()), 1, 1);
    std::copy(values.begin(), values.end(), image.floats().begin());
    return image;
}

/// Decodes, compares, and encodes back to what was stored.
void expect_depth(const RoleDecoding& decoding, const DecodeContext& with,
                  std::initializer_list<float> stored, std::initializer_list<float> expected_m) {
    Image image = depth_of(stored);
    decode_depth(image, decoding, with);
    const Image expected = depth_of(expected_m);
    for (std::size_t i = 0; i < expected.floats().size(); ++i) {
        const float m = expected.floats()[i];
        if (std::isinf(m)) EXPECT_TRUE(std::isinf(image.floats()[i])) << i;
        else EXPECT_NEAR(image.floats()[i], m, 2e-5 * m) << i;
    }
    encode_depth(image, decoding, with);
    const Image again = depth_of(stored);
    for (std::size_t i = 0; i < again.floats().size(); ++i)
        EXPECT_NEAR(image.floats()[i], again.floats()[i], 1e-5 * (1 + std::abs(again.floats()[i]))) << i;
}

TEST(ProducerDepth, OfUnrealIsCentimetresWithTheSkyAtZero) {
    expect_depth(profile("unreal").roles.at("depth"), context(), {250, 0}, {2.5f, kInfinity});
}

TEST(ProducerDepth, OfUnityRunsFromOneAtTheNearToZeroAtTheFarPlane) {
    DecodeContext with = context();
    with.camera.set("near", 0.5);
    with.camera.set("far", 100.5);
    expect_depth(profile("unity").roles.at("depth"), with, {1, 0.75f, 0}, {0.5f, 25.5f, kInfinity});
}

TEST(ProducerDepth, ThatNeedsNearAndFarSaysSo) {
    Image image = depth_of({0.5f});
    const std::string message =
        capture_error([&] { decode_depth(image, profile("unity").roles.at("depth"), context()); });
    EXPECT_NE(message.find("near"), std::string::npos) << message;
}

TEST(ProducerDepth, InAZBufferFollowsThePerspectiveDivide) {
    RoleDecoding decoding;
    decoding.encoding = DepthEncoding::z_buffer;
    decoding.near_m = 0.1, decoding.far_m = 1000;
    // z_buffer = far (z - near) / (z (far - near)), by hand for z = 0.1, 2 and 500 m.
    const auto stored = [](double z) { return float(1000 * (z - 0.1) / (z * (1000 - 0.1))); };
    Image image = depth_of({stored(0.1), stored(2), stored(500), 1});
    decode_depth(image, decoding, context());
    EXPECT_NEAR(image.floats()[0], 0.1, 1e-6);
    EXPECT_NEAR(image.floats()[1], 2, 1e-4);
    EXPECT_NEAR(image.floats()[2], 500, 0.3);  // what a float z-buffer resolves there
    EXPECT_TRUE(std::isinf(image.floats()[3]));
    decoding.reversed = true;
    expect_depth(decoding, context(), {1, 1 - stored(2), 0}, {0.1f, 2, kInfinity});
}

TEST(ProducerDepth, OfGodotIsAReversedZBuffer) {
    DecodeContext with = context();
    with.camera.set("near", 0.1);
    with.camera.set("far", 1000);
    // near (far - z) / (z (far - near)), by hand for 2 m.
    const float at_2_m = float(0.1 * (1000 - 2) / (2 * (1000 - 0.1)));
    expect_depth(profile("godot").roles.at("depth"), with, {1, at_2_m, 0}, {0.1f, 2, kInfinity});
}

TEST(ProducerDepth, OfNukesScanlineRenderIsOneOverZ) {
    RoleDecoding decoding;
    decoding.encoding = DepthEncoding::inverse;
    expect_depth(decoding, context(), {0.5f, 4, 0}, {2, 0.25f, kInfinity});
}

TEST(ProducerDepth, ThatIsRadialIsBroughtToTheAxis) {
    RoleDecoding decoding;
    decoding.radial = true;
    DecodeContext with = context();
    with.grid = with.display = {0, 0, 3, 0};
    with.camera.set("focal_length", 36);
    with.camera.set("sensor_width", 36);
    // f is 4 px; pixel 3 lies 1.5 px right of the middle, on the row of the middle.
    Image image(4, 1, 1);
    for (float& z : image.floats()) z = 10;
    decode_depth(image, decoding, with);
    EXPECT_NEAR(image.at(3, 0, 0), 10 * 4 / std::hypot(4, 1.5), 1e-5);
    encode_depth(image, decoding, with);
    EXPECT_NEAR(image.at(3, 0, 0), 10, 1e-5);
}

TEST(ProducerDepth, OfCyclesAndEeveeBothMarkNothingHit) {
    const RoleDecoding& decoding = profile("blender").roles.at("depth");
    Image image = depth_of({6.4f, 1e10f, 65504});
    decode_depth(image, decoding, context());
    EXPECT_EQ(image.floats()[0], 6.4f);
    EXPECT_TRUE(std::isinf(image.floats()[1]) && std::isinf(image.floats()[2]));
    encode_depth(image, decoding, context());
    EXPECT_EQ(image.floats()[1], 1e10f);
}

}  // namespace
}  // namespace aftershade::test
