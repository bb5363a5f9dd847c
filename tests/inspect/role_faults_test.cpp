#include "framework/inspect/role_faults.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace aftershade::test {
namespace {

constexpr int kSize = 48;

/// A camera at the origin that looks along -z, a sphere's bulge below a flat wall; the lower rows lie nearer.
struct Frame {
    Image depth{kSize, kSize, 1}, position{kSize, kSize, 3}, normal{kSize, kSize, 3};
    Frame() {
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const double u = (x + 0.5) / kSize - 0.5, v = 0.5 - (y + 0.5) / kSize;
                const double z = 5 + std::sin(9 * u) - 3 * v * v * v + v;
                depth.at(x, y, 0) = float(z);
                position.at(x, y, 0) = float(u * z);
                position.at(x, y, 1) = float(v * z);
                position.at(x, y, 2) = float(-z);
                normal.at(x, y, 0) = float(0.6 * std::sin(9 * u));
                normal.at(x, y, 1) = 0;
                normal.at(x, y, 2) = float(std::sqrt(1 - std::pow(0.6 * std::sin(9 * u), 2)));
            }
    }
};

Camera camera_moved_back(double by_m) {
    Camera camera;
    camera.camera_from_world = CameraMatrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -by_m, 0, 0, 0, 1};
    return camera;
}

TEST(RoleFaults, SoundRolesHaveNone) {
    const Frame frame;
    EXPECT_EQ(find_position_fault(frame.depth, frame.position, camera_moved_back(0)), "");
    EXPECT_EQ(find_normal_fault(frame.normal), "");
}

TEST(RoleFaults, DepthUpsideDownIsToldFromOtherContradictions) {
    Frame frame;
    const Image sound = frame.depth;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) frame.depth.at(x, y, 0) = sound.at(x, kSize - 1 - y, 0);
    EXPECT_NE(find_position_fault(frame.depth, frame.position, {}).find("upside down"), std::string::npos);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) frame.depth.at(x, y, 0) = 1 / sound.at(x, y, 0);
    EXPECT_NE(find_position_fault(frame.depth, frame.position, {}).find("contradicts the position"),
              std::string::npos);
}

TEST(RoleFaults, MatricesOfAnotherPlaceContradictDepthAndPosition) {
    const Frame frame;
    EXPECT_NE(
        find_position_fault(frame.depth, frame.position, camera_moved_back(3)).find("the camera's matrices"),
        std::string::npos);
}

TEST(RoleFaults, NormalsThatArePackedOrLongAreNamed) {
    Frame packed, longer;
    for (float& value : packed.normal.floats()) value = 0.5f * value + 0.5f;
    for (float& value : longer.normal.floats()) value *= 1.5f;
    EXPECT_NE(find_normal_fault(packed.normal).find("are packed"), std::string::npos);
    EXPECT_NE(find_normal_fault(longer.normal).find("have length 1.5"), std::string::npos);
}

}  // namespace
}  // namespace aftershade::test
