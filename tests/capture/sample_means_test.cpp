// Values averaged over a pixel's samples, held against edges whose samples a formula gives.
#include "framework/capture/sample_means.h"

#include <cmath>
#include <functional>
#include <limits>

#include "framework/capture/decode.h"
#include "tests/capture/capture_files.h"

namespace aftershade::test {
namespace {

constexpr int kWidth = 48, kHeight = 40;

/// A slanted edge: the near surface is a plane that recedes to the right, the far one is level.
bool is_near(double x, double y) {
    return x + 0.37 * y < 28.3;
}
double near_depth(double x) {
    return 4 + 0.02 * x;
}
double depth_at(double x, double y, double far) {
    return is_near(x, y) ? near_depth(x) : far;
}

/// The mean of a value over `reach` px to either side of each pixel's middle (0.5: the pixel itself).
Image mean_image(int channels, double reach, const std::function<double(double, double, int)>& value_at) {
    constexpr int kSamples = 16;
    Image image(kWidth, kHeight, channels);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < channels; ++c) {
                double sum = 0;
                for (int i = 0; i < kSamples * kSamples; ++i) {
                    const double dx = ((i % kSamples + 0.5) / kSamples * 2 - 1) * reach,
                                 dy = ((i / kSamples + 0.5) / kSamples * 2 - 1) * reach;
                    sum += value_at(x + 0.5 + dx, y + 0.5 + dy, c);
                }
                image.at(x, y, c) = float(sum / (kSamples * kSamples));
            }
    return image;
}

Image mean_depth(double reach, double far) {
    return mean_image(1, reach, [&](double x, double y, int) { return depth_at(x, y, far); });
}

/// Pixels off the picture's border whose depth is neither surface's there, but for what the near surface
/// rises in two pixels: a mean with a few hundredths of the other surface passes for its own.
int pixels_in_mid_air(const Image& depth, double far) {
    constexpr double kTwoPixels = 2 * 0.02;
    int count = 0;
    for (int y = 3; y < kHeight - 3; ++y)
        for (int x = 3; x < kWidth - 3; ++x) {
            const double value = depth.at(x, y, 0);
            const bool is_far = std::abs(value - far) <= std::max(kTwoPixels, 1e-6 * far);
            if (!is_far && std::abs(value - near_depth(x + 0.5)) > kTwoPixels) ++count;
        }
    return count;
}

class MeanDepth : public testing::TestWithParam<double> {};

TEST_P(MeanDepth, IsPutOnTheSurfaceThatItIsNearerTo) {
    for (const double far : {9.0, 500.0, 1e10}) {
        Image depth = mean_depth(GetParam(), far);
        EXPECT_GT(pixels_in_mid_air(depth, far), kHeight / 2) << far;
        EXPECT_GT(repair_means(depth), 0u);
        EXPECT_EQ(pixels_in_mid_air(depth, far), 0) << far;
    }
}

/// Half the width of a renderer's filter: the pixel itself, and 1.5 px on every side.
INSTANTIATE_TEST_SUITE_P(Filters, MeanDepth, testing::Values(0.5, 0.75), [](const auto& reach) {
    return "OfReach" + std::to_string(int(100 * reach.param));
});

TEST(MeanDepth, OfAPixelThatIsHalfOfEachIsOneOfThem) {
    Image depth(7, 1, 1);
    const float row[] = {2, 2, 2, 4.5f, 8, 8, 8};
    for (int x = 0; x < 7; ++x) depth.at(x, 0, 0) = row[x];
    EXPECT_EQ(repair_means(depth), 1u);
    EXPECT_EQ(depth.at(3, 0, 0), 2);
}

TEST(MeanDepth, OfSmoothSurfacesStaysToTheBit) {
    Image depth = mean_image(1, 0.5, [](double x, double y, int) {
        return 5 + std::sin(0.3 * x) + 0.5 * std::cos(0.2 * y) + 0.05 * x;
    });
    const Image before = depth;
    EXPECT_EQ(repair_means(depth), 0u);
    EXPECT_TRUE(std::ranges::equal(depth.floats(), before.floats()));
}

/// Of one sample a pixel: edges, a post of two pixels between two depths, and no hit.
TEST(MeanDepth, OfSinglePointsStaysToTheBit) {
    Image depth = mean_image(1, 0, [](double x, double y, int) {
        if (y < 5) return double(std::numeric_limits<float>::infinity());
        if (x > 20 && x < 22) return 6.0;
        return x < 21 ? 4.0 : 9.0;
    });
    const Image before = depth;
    EXPECT_EQ(repair_means(depth), 0u);
    EXPECT_TRUE(std::ranges::equal(depth.floats(), before.floats()));
}

TEST(MeanNormals, AreOneOfTheTwoSurfacesAtAnEdge) {
    const auto normal_at = [](double x, double y, int c) {
        return is_near(x, y) ? (c == 0 ? 1.0 : 0.0) : (c == 2 ? 1.0 : 0.0);
    };
    for (const bool is_unit_again : {false, true}) {
        Image normal = mean_image(3, 0.5, normal_at);
        for (int i = 0; is_unit_again && i < kWidth * kHeight; ++i) {
            float* n = &normal.floats()[std::size_t(3 * i)];
            const float length = std::hypot(n[0], n[1], n[2]);
            for (int c = 0; c < 3; ++c) n[c] /= length;
        }
        repair_means(normal);
        for (int y = 3; y < kHeight - 3; ++y)
            for (int x = 3; x < kWidth - 3; ++x)
                EXPECT_NEAR(std::max(normal.at(x, y, 0), normal.at(x, y, 2)), 1, 1e-3) << x << ", " << y;
    }
}

TEST(DepthEdges, OfMeansAreToldFromThoseOfSinglePoints) {
    const auto tiles = [](double x, double y, int) { return std::fmod(x + 0.3 * y, 8) < 4 ? 4.0 : 7.0; };
    const DepthEdges means = find_depth_edges(mean_image(1, 0.5, tiles));
    EXPECT_TRUE(means.are_of_means()) << means.mixed << " of " << means.mixed + means.sharp;
    const DepthEdges points = find_depth_edges(mean_image(1, 0, tiles));
    EXPECT_FALSE(points.are_of_means());
    EXPECT_EQ(points.mixed, 0u);
    EXPECT_GT(points.sharp, 300u);
}

/// Samples of points, every one of them; Beachball's depth is in half floats with noise of two steps.
TEST(DepthEdges, OfNoRealCaptureAreTakenForMeans) {
    int files = 0;
    Diagnostics diagnostics;
    const std::vector<Profile> profiles = read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics);
    for (const char* folder : {"suzanne", "head", "beachball", "blender-versions", "producers"}) {
        AFTERSHADE_REQUIRE_CAPTURE(path, folder);
        for (const auto& entry : std::filesystem::recursive_directory_iterator(*path)) {
            if (entry.path().extension() != ".exr") continue;
            const std::string name = entry.path().filename().string();
            if (name.find("deep") != std::string::npos) continue;
            const Sequence sequence = sequence_of(entry.path(), "auto");
            const CaptureReader reader(sequence, profiles, {});
            Capture capture = reader.read(1, std::vector<std::string>{"depth"});
            if (name.find("linearZ") != std::string::npos)
                capture.images["depth"] = ExrFile(entry.path()).read_floats(0, std::vector<std::string>{"R"});
            if (!capture.images.contains("depth")) continue;
            ++files;
            const DepthEdges edges = find_depth_edges(capture.images.at("depth"));
            EXPECT_FALSE(edges.are_of_means())
                << entry.path() << ": " << edges.mixed << " of " << edges.mixed + edges.sharp;
            RecordProperty(name,
                           std::to_string(edges.mixed) + " of " + std::to_string(edges.mixed + edges.sharp));
        }
    }
    EXPECT_GT(files, 20);
}

/// 0 where nothing was hit, as Mitsuba stores it.
TEST(MeanRole, IsRepairedAsItIsStored) {
    const Image depth =
        decoded("depth", R"({"channels": ["Z"], "sampling": "mean", "scale": 2, "zero_is_no_hit": true})",
                {{"Z", {3, 3, 3, 1, 0, 0, 0, 0}}});
    EXPECT_EQ(depth.at(2, 0, 0), 6);
    for (int x = 3; x < 8; ++x) EXPECT_TRUE(std::isinf(depth.at(x, 0, 0))) << x;
    const Image position = decoded("position", R"({"channels": ["P.X", "P.Y", "P.Z"], "sampling": "mean"})",
                                   {{"P.X", {1, 1, 1, 2, 5, 5, 5}},
                                    {"P.Y", std::vector<float>(7, 2)},
                                    {"P.Z", std::vector<float>(7, 3)}});
    EXPECT_EQ(position.at(3, 0, 0), 1);
}

TEST(MeanRole, IsNoRoleOfIds) {
    const std::string message = capture_error([&] {
        decoded("object_id", R"({"channels": ["id"]})", {{"id", {1, 1.5f, 2}}});
    });
    EXPECT_NE(message.find("object id 1.500000 at pixel (1, 0) is not a whole number"), std::string::npos)
        << message;
    EXPECT_NE(message.find("ids that are averaged over samples name no object (render them with one sample"),
              std::string::npos)
        << message;
}

/// Mitsuba's dd.T is along the ray and begins at the near plane.
TEST(DepthOffset, IsAddedToThePlanarDepthAndTakenAwayAgain) {
    Image depth(3, 3, 1);
    for (float& value : depth.floats()) value = 2;
    RoleDecoding decoding;
    decoding.radial = true;
    decoding.offset_m = 0.5;
    DecodeContext context{"f.exr", {0, 0, 2, 2}, {0, 0, 2, 2}, {}, nullptr};
    context.camera.set("focal_length", 10);
    context.camera.set("sensor_width", 20);  // 1.5 px of focal length
    const Image stored = depth;
    decode_depth(depth, decoding, context);
    EXPECT_FLOAT_EQ(depth.at(1, 1, 0), 2.5f);
    EXPECT_NEAR(depth.at(0, 1, 0), 2 * 1.5 / std::hypot(1.5, 1.0) + 0.5, 1e-6);
    encode_depth(depth, decoding, context);
    for (int i = 0; i < 9; ++i)
        EXPECT_NEAR(depth.floats()[std::size_t(i)], stored.floats()[std::size_t(i)], 1e-6);
    EXPECT_FLOAT_EQ(decoded("depth", R"({"channels": ["Z"], "offset": "25 cm"})", {{"Z", {1}}}).at(0, 0, 0),
                    1.25f);
}

}  // namespace
}  // namespace aftershade::test
