// What lies behind, against closed forms.
#include <atomic>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "framework/capture/capture.h"
#include "framework/capture/sequence.h"
#include "framework/image/role.h"
#include "framework/scene/job.h"
#include "tests/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace aftershade::scene {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// 100 px per unit of tangent: a ball 10 m away, which is closed, before a wall of 6 m height 15 m away, and
/// an open card, seen from behind, between them in the right half.
Scene ball_before_wall() {
    return scene_of(R"({ "aftershade": 1, "size": [200, 100],
        "camera": { "position": [0, 0, 10], "focal_length": 18, "sensor_width": 36 },
        "background": 0.5,
        "materials": { "grey": { "albedo": 0, "specular": 0, "emission": 0.25 },
                       "light": { "albedo": 0, "specular": 0, "emission": 2 } },
        "objects": [ { "id": 4, "shape": "sphere", "radius": 2, "material": "grey" },
                     { "id": 6, "shape": "plane", "size": [4, 2], "position": [3.5, 0, -3], "rotation": [0, 180, 0],
                       "material": "light" },
                     { "id": 9, "shape": "plane", "size": [100, 6], "position": [0, 0, -5], "material": "light" } ] })");
}

/// Which objects the ray through a pixel's position meets, front to back; the ball's inside does not count.
std::vector<unsigned> ids_along(double x, double y) {
    const double tangent_x = (x - 100) / 100, tangent_y = (50 - y) / 100;
    std::vector<unsigned> ids;
    if (100 * std::hypot(tangent_x, tangent_y) < 100 * 2 / std::sqrt(96.0)) ids.push_back(4);
    if (std::abs(tangent_x * 13 - 3.5) < 2 && std::abs(tangent_y * 13) < 1) ids.push_back(6);
    if (std::abs(tangent_y * 15) < 3) ids.push_back(9);
    return ids;
}

TEST(SceneLayers, HaveTheWallBehindTheBall) {
    const Scene scene = ball_before_wall();
    const SceneRenderer renderer(scene, 200, 100, 2);
    const std::vector<Capture> layers = renderer.render_layers(1, 1, {0, 0}, 4);
    ASSERT_EQ(layers.size(), 4u);
    int behind_ball = 0;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 200; ++x) {
            const std::vector<unsigned> ids = ids_along(x + 0.5, y + 0.5);
            for (std::size_t k = 0; k < 4; ++k) {
                const auto& images = layers[k].images;
                const unsigned id = k < ids.size() ? ids[k] : 0;
                ASSERT_EQ(images.at("object_id").uint_at(x, y, 0), id) << x << " " << y << " " << k;
                ASSERT_EQ(images.at("color").at(x, y, 3), k <= ids.size() ? 1 : 0);
                const float light = k > ids.size() ? 0 : id == 0 ? 0.5f : id == 4 ? 0.25f : 2;
                ASSERT_EQ(images.at("color").at(x, y, 0), light);
                if (id == 6) {
                    ASSERT_FLOAT_EQ(images.at("depth").at(x, y, 0), 13);
                }
                if (id == 9) {
                    ASSERT_FLOAT_EQ(images.at("depth").at(x, y, 0), 15);
                }
                if (id == 0) {
                    ASSERT_EQ(images.at("depth").at(x, y, 0), kFar);
                }
            }
            behind_ball += ids.size() > 1 && ids[0] == 4;
        }
    EXPECT_GT(behind_ball, 1000);
}

TEST(SceneLayers, BeginWithTheCaptureItself) {
    const Scene scene = shipped_scene("wheel");
    const SceneRenderer renderer(scene, 64, 36, 2);
    const Capture capture = renderer.render_capture(2);
    const std::vector<Capture> layers = renderer.render_layers(2, 2, {0, 0}, 3);
    for (const auto& [role, image] : capture.images) {
        const Image& same = layers.front().images.at(role);
        if (image.type() == ComponentType::uint32)
            EXPECT_TRUE(std::ranges::equal(image.uints(), same.uints()));
        else EXPECT_TRUE(std::ranges::equal(image.floats(), same.floats())) << role.name();
    }
}

class SceneLayerFiles : public testing::Test {
protected:
    static std::vector<Profile> profiles() {
        Diagnostics diagnostics;
        return read_profiles(std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "profiles", diagnostics);
    }
    Capture rendered(Job job, const std::vector<RoleId>& roles) {
        const Scene scene = ball_before_wall();
        job.folder = folder_.path();
        job.frames = {1};
        job.width_px = 200;
        job.height_px = 100;
        const std::atomic<bool> stop = false;
        const std::vector<Profile> known = profiles();
        const auto native = std::ranges::find(known, "native", &Profile::id);
        run_job(scene, *native, job, stop, [](int) {});
        Diagnostics diagnostics;
        sequence_ = open_sequence((folder_ / "capture.json").string(), diagnostics);
        EXPECT_EQ(faults_of(diagnostics), "");
        return CaptureReader(*sequence_, known, {}).read(1, roles);
    }
    test::TemporaryFolder folder_;
    std::optional<Sequence> sequence_;
};

TEST_F(SceneLayerFiles, AreACaptureWithLayers) {
    Job job;
    job.layers = 2;
    const Capture capture = rendered(job, {"color", RoleId::of_layer(1, "color"),
                                           RoleId::of_layer(1, "depth"), RoleId::of_layer(1, "velocity")});
    EXPECT_EQ(capture.header.layer_count, 2);
    EXPECT_EQ(capture.images.at("color").at(100, 50, 0), 0.25f);
    EXPECT_EQ(capture.images.at(RoleId::of_layer(1, "color")).at(100, 50, 0), 2);
    EXPECT_EQ(capture.images.at(RoleId::of_layer(1, "depth")).at(100, 50, 0), 15);
    EXPECT_EQ(capture.images.at(RoleId::of_layer(1, "velocity")).at(100, 50, 0), 0);
}

/// The flat picture is the mean of the rays where one thing alone covers part of a pixel.
TEST_F(SceneLayerFiles, OfDeepSamplesHoldTheShareOfEachSurface) {
    Job job;
    job.deep = true;
    const Capture capture =
        rendered(job, {"color", "depth", RoleId::of_layer(0, "color"), RoleId::of_layer(1, "color"),
                       RoleId::of_layer(1, "depth"), RoleId::of_layer(0, "object_id")});
    int edges = 0;
    for (int y = 35; y < 65; ++y)
        for (int x = 75; x < 100; ++x) {  // where the ball's edge is before the wall, and no card
            int on_ball = 0;
            for (int i = 0; i < 16; ++i)
                on_ball += ids_along(x + (i % 4 + 0.5) / 4, y + (i / 4 + 0.5) / 4).front() == 4 ? 1 : 0;
            const double share = on_ball / 16.0;
            ASSERT_NEAR(capture.images.at("color").at(x, y, 0), share * 0.25 + (1 - share) * 2, 1e-5);
            if (on_ball == 0) continue;
            edges += on_ball < 16;
            ASSERT_NEAR(capture.images.at(RoleId::of_layer(0, "color")).at(x, y, 3), share, 1e-6)
                << x << " " << y;
            ASSERT_NEAR(capture.images.at(RoleId::of_layer(1, "color")).at(x, y, 0), 2, 1e-5);
            ASSERT_FLOAT_EQ(capture.images.at(RoleId::of_layer(1, "depth")).at(x, y, 0), 15);
            ASSERT_EQ(capture.images.at(RoleId::of_layer(0, "object_id")).uint_at(x, y, 0), 4u);
        }
    EXPECT_GT(edges, 20);
    ASSERT_TRUE(capture.deep);
    EXPECT_GE(capture.deep->most_samples, 3u);
    EXPECT_EQ(capture.header.camera.get("focal_length"), 18);
}

TEST_F(SceneLayerFiles, AreRefusedWhereTheyMeanNothing) {
    Diagnostics diagnostics;
    Job job;
    job.folder = folder_.path();
    job.frames = {1};
    job.deep = true;
    job.layers = 2;
    check_job(ball_before_wall(), job, diagnostics);
    EXPECT_NE(faults_of(diagnostics).find("layers: error: is not for deep"), std::string::npos)
        << faults_of(diagnostics);
}

}  // namespace
}  // namespace aftershade::scene
