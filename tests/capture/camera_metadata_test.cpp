#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "framework/capture/camera_metadata.h"
#include "framework/capture/camera_motion.h"
#include "framework/capture/capture.h"
#include "tests/file/image_files.h"

namespace aftershade::test {
namespace {

constexpr int kWidth = 64, kHeight = 36;
const Window kWindow{0, 0, kWidth - 1, kHeight - 1};
constexpr double kFocalMm = 50, kSensorMm = 36;

/// A camera at (x, 0, z), turned by `yaw_rad` about +y, looking along -z; with a square-pixel pinhole
/// projection.
Camera camera_at(double x, double z, double yaw_rad) {
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    // camera_from_world = inverse of (translate * rotate_y).
    const CameraMatrix view = {c, 0, -s, -(c * x - s * z), 0, 1, 0, 0, s, 0, c, -(s * x + c * z), 0, 0, 0, 1};
    const double px = 2 * kFocalMm / kSensorMm, py = px * kWidth / kHeight;
    const CameraMatrix projection = {px, 0, 0, 0, 0, py, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0};
    CameraMatrix both{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            for (std::size_t k = 0; k < 4; ++k)
                both[row * 4 + column] += projection[row * 4 + k] * view[k * 4 + column];
    Camera camera;
    camera.camera_from_world = view;
    camera.ndc_from_world = both;
    return camera;
}

Image filled_velocity(const Camera& current, const Camera& previous, float depth_m) {
    Image velocity(kWidth, kHeight, 2), depth(kWidth, kHeight, 1);
    for (float& z : depth.floats()) z = depth_m;
    std::vector<std::size_t> pixels(std::size_t(kWidth) * kHeight);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = i;
    fill_camera_velocity(velocity, pixels, depth, kWindow, kWindow, current, previous);
    return velocity;
}

TEST(CameraMotion, OfACameraThatMovesRightIsToTheLeftByParallax) {
    const Image velocity = filled_velocity(camera_at(0.1, 0, 0), camera_at(0, 0, 0), 5);
    // f / sensor * width px for a slope of 1: 0.1 m at 5 m.
    const double expected_px = -0.1 / 5 * kFocalMm / kSensorMm * kWidth;
    for (int y = 0; y < kHeight; y += 5)
        for (int x = 0; x < kWidth; x += 5) {
            EXPECT_NEAR(velocity.at(x, y, 0), expected_px, 1e-4);
            EXPECT_NEAR(velocity.at(x, y, 1), 0, 1e-4);
        }
}

TEST(CameraMotion, OfACameraThatMovesForwardGoesOutFromTheMiddleWithRowsDown) {
    const Image velocity = filled_velocity(camera_at(0, -1, 0), camera_at(0, 0, 0), 4);
    // A point at 4 m now was at 5 m: its offset from the middle was 4/5 of what it is.
    EXPECT_NEAR(velocity.at(60, 18, 0), (60.5 - 32) * (1 - 4.0 / 5), 1e-3);
    EXPECT_NEAR(velocity.at(32, 30, 1), (30.5 - 18) * (1 - 4.0 / 5), 1e-3);
    EXPECT_LT(velocity.at(32, 5, 1), 0);
}

TEST(CameraMotion, AtInfinityCountsTurningAlone) {
    const float inf = std::numeric_limits<float>::infinity();
    const Image moved = filled_velocity(camera_at(3, -2, 0), camera_at(0, 0, 0), inf);
    for (const float v : moved.floats()) ASSERT_NEAR(v, 0, 1e-4);
    const double yaw = 1 * std::numbers::pi / 180;
    const Image turned = filled_velocity(camera_at(0, 0, yaw), camera_at(0, 0, 0), inf);
    // Turning left (about +y) moves everything right, by f tan(yaw) near the middle.
    EXPECT_NEAR(turned.at(32, 18, 0), std::tan(yaw) * kFocalMm / kSensorMm * kWidth, 0.01);
}

TEST(CameraMetadata, ReadsUnrealsAttributesInTheirUnits) {
    const TemporaryFolder folder;
    const Image image(2, 2, 3);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 1};
    const std::string head = "unreal/camera/FinalImage/";
    options.attributes = {{head + "focalDistance", 250.0f},
                          {head + "focalLength", 35.0f},
                          {head + "sensorWidth", 23.76f},
                          {head + "fstop", std::string("2.8")},
                          {head + "dofDiaphragmBladeCount", 7}};
    write_exr(folder / "unreal.0001.exr", channels, options);
    Sequence sequence;
    sequence.files = FramePattern((folder / "unreal.0001.exr").string());
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    const CaptureHeader header = reader.read_header(1);
    EXPECT_EQ(header.profile, "unreal");
    EXPECT_NEAR(*header.camera.get("focus_distance"), 2.5, 1e-9);
    EXPECT_NEAR(*header.camera.get("focal_length"), 35, 1e-6);
    EXPECT_NEAR(*header.camera.get("sensor_width"), 23.76, 1e-5);
    EXPECT_NEAR(*header.camera.get("f_number"), 2.8, 1e-9);
    EXPECT_EQ(*header.camera.get("blades"), 7);
}

/// Arnold's 45 degrees are CameraFocalLength 1 / (2 tan 22.5 degrees) = 1.2071 sensors wide.
TEST(CameraMetadata, HasArnoldsFocalLengthWhereTheWidthOfTheSensorIsKnown) {
    const TemporaryFolder folder;
    const Image image(2, 2, 3);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 1};
    options.attributes = {{"arnold/version", std::string("Arnold 7.5.0.0")},
                          {"CameraFocalLength", 1.2071068f}};
    write_exr(folder / "arnold.0001.exr", channels, options);
    Sequence sequence;
    sequence.files = FramePattern((folder / "arnold.0001.exr").string());
    Diagnostics diagnostics;
    const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics), {});
    EXPECT_FALSE(reader.read_header(1).camera.get("focal_length"));
    sequence.camera.set("sensor_width", 36);
    EXPECT_NEAR(reader.read_header(1).camera.get("focal_length").value_or(0), 18 * (1 + std::numbers::sqrt2),
                1e-5);
}

/// The lens of a header of V-Ray with these attributes, beside what capture.json says.
Camera vray_lens(std::map<std::string, ExrValue> attributes, const Camera& given = {}) {
    const TemporaryFolder folder;
    const Image image(2, 2, 3);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 1};
    options.attributes = std::move(attributes);
    options.attributes["vrayInfo/vraycore"] = std::string("3.60.04");
    write_exr(folder / "f.exr", channels, options);
    Diagnostics diagnostics;
    for (const Profile& profile : read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics))
        if (profile.id == "vray")
            return camera_of_metadata(ExrFile(folder / "f.exr").parts()[0], profile, given);
    throw std::runtime_error("no profile vray");
}

/// Headers that public pages print: of 3ds Max, without a focal length; of V-Ray 3.60.04 for Maya, a square
/// picture of 36 x 24 mm film, which shows 24 mm of its width: 2 atan(12 / 35) = 37.85 degrees.
TEST(CameraMetadata, HasVRaysLensByTheAngleThatThePictureShows) {
    const Camera max = vray_lens({{"cameraAperture", 36.0f}, {"cameraFov", 54.4204f}});
    EXPECT_NEAR(max.get("focal_length").value_or(0), 35.008, 1e-3);
    EXPECT_NEAR(max.get("sensor_width").value_or(0), 36, 1e-6);
    EXPECT_EQ(max.origin("focal_length"), "attribute cameraFov");

    const std::map<std::string, ExrValue> square = {
        {"cameraAperture", 35.9999f}, {"cameraFocalLength", 35.0f}, {"cameraFov", 37.8493f}};
    EXPECT_NEAR(vray_lens(square).get("focal_length").value_or(0), 35, 1e-6);
    EXPECT_NEAR(vray_lens(square).get("sensor_width").value_or(0), 24, 1e-3);

    Camera given;
    given.set("sensor_width", 48, "capture.json");
    EXPECT_NEAR(vray_lens(square, given).get("focal_length").value_or(0), 70, 3e-3) << "the angle stays";
    EXPECT_NEAR(vray_lens({{"cameraFov", 90.0f}}, given).get("focal_length").value_or(0), 24, 1e-5);
    EXPECT_FALSE(vray_lens({{"cameraFov", 90.0f}}).get("focal_length"));
    EXPECT_FALSE(vray_lens({{"cameraAperture", 36.0f}, {"cameraFov", 0.0f}}).get("focal_length"));
}

TEST(CameraMetadata, ReadsOpenExrsStandardAttributes) {
    const TemporaryFolder folder;
    const Image image(2, 2, 1);
    const std::vector<ExrOutputChannel> channels = {{"R", PixelType::half, &image, 0}};
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 1, 1};
    // A camera at the origin that looks along -z, 90 degrees wide.
    options.attributes = {
        {"focus", 3.5f},
        {"aperture", 1.4f},
        {"worldToCamera", std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}},
        {"worldToNDC", std::vector<float>{0.5f, 0, 0, 0, 0, -0.5f, 0, 0, -0.5f, -0.5f, -1, -1, 0, 0, 0, 0}}};
    write_exr(folder / "a.exr", channels, options);
    const ExrFile file(folder / "a.exr");
    const Camera camera = camera_of_metadata(file.parts()[0], Profile{});
    EXPECT_FLOAT_EQ(float(*camera.get("focus_distance")), 3.5f);
    EXPECT_FLOAT_EQ(float(*camera.get("f_number")), 1.4f);
    EXPECT_EQ(camera.matrices_found, "worldToCamera, +z ahead; worldToNDC, 0 to 1 with y down");
    EXPECT_TRUE(knows_motion(camera, camera));
}

}  // namespace
}  // namespace aftershade::test
