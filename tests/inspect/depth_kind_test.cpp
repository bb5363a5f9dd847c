#include "framework/inspect/depth_kind.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/camera_pose.h"

namespace aftershade::test {
namespace {

constexpr int kWidth = 96, kHeight = 54;

struct Pictures {
    Image depth{kWidth, kHeight, 1}, position{kWidth, kHeight, 3};
};

/// Waves before a camera that looks aslant; the sky has no hit.
Pictures waves(bool radial) {
    CameraPose pose;
    pose.position_m = {3, 2, 7};
    pose.angles_deg = {-20, 40, 5};
    pose.focal_length_mm = 24;
    Pictures pictures;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool is_sky = y < 6;
            const double z = 4 + std::sin(0.3 * x) + 2 * std::cos(0.17 * y);
            const glm::dvec4 world = pose.world_at({x + 0.5, y + 0.5}, z, kWidth, kHeight);
            const double distance = glm::length(glm::dvec3(world) - pose.position_m);
            pictures.depth.at(x, y, 0) =
                is_sky ? std::numeric_limits<float>::infinity() : float(radial ? distance : z);
            for (int c = 0; c < 3; ++c) pictures.position.at(x, y, c) = is_sky ? 0.0f : float(world[c]);
        }
    return pictures;
}

TEST(DepthKind, IsPlanarAlongTheAxis) {
    const Pictures pictures = waves(false);
    const DepthKind kind = find_depth_kind(pictures.depth, pictures.position);
    EXPECT_EQ(kind.verdict(), DepthKind::Verdict::planar);
    EXPECT_LT(kind.planar_error, 1e-5);
    EXPECT_GT(kind.radial_error, 0.01);
}

TEST(DepthKind, IsRadialFromTheCamera) {
    const Pictures pictures = waves(true);
    const DepthKind kind = find_depth_kind(pictures.depth, pictures.position);
    EXPECT_EQ(kind.verdict(), DepthKind::Verdict::radial);
    EXPECT_LT(kind.radial_error, 1e-5);
    EXPECT_GT(kind.planar_error, 0.01);
}

TEST(DepthKind, IsUnknownWhereNothingFitsOrNothingIsHit) {
    Pictures pictures = waves(false);
    for (float& value : pictures.depth.floats()) value = 1 + std::fmod(value * 7919, 1.0f);
    EXPECT_EQ(find_depth_kind(pictures.depth, pictures.position).verdict(), DepthKind::Verdict::unknown);
    for (float& value : pictures.depth.floats()) value = std::numeric_limits<float>::infinity();
    EXPECT_EQ(find_depth_kind(pictures.depth, pictures.position).pixels, 0u);
}

}  // namespace
}  // namespace aftershade::test
