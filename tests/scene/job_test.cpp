// Jobs: what they refuse, and what they leave in the folder.
#include "framework/scene/job.h"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "framework/core/data_path.h"
#include "tests/scene/scene_text.h"

namespace aftershade::scene {
namespace {

const char* const kBall = R"({ "aftershade": 1, "size": [4, 4], "frames": "1-5", "camera": {},
    "materials": { "grey": {} }, "objects": [ { "shape": "sphere", "radius": 1, "material": "grey" } ] })";

std::string faults(const Scene& scene, Job job) {
    Diagnostics diagnostics;
    if (job.folder.empty()) job.folder = "anywhere";
    check_job(scene, job, diagnostics);
    return faults_of(diagnostics);
}

TEST(Job, RefusesFileNumbersThatNoRangeCanName) {
    const Scene scene = scene_of(kBall);
    Job job;
    job.subframes = 1024;
    job.frames = {1, 976561};
    EXPECT_EQ(faults(scene, job), "");
    job.frames = {1, 976562};
    EXPECT_NE(faults(scene, job).find("--subframes: error: file numbers"), std::string::npos);
    job.frames = {-999999999};
    EXPECT_NE(faults(scene, job).find("--subframes: error: file numbers"), std::string::npos);
}

TEST(Job, RefusesAFolderWithoutAName) {
    Diagnostics diagnostics;
    check_job(scene_of(kBall), Job{}, diagnostics);
    EXPECT_NE(faults_of(diagnostics).find("--output: error: names no folder"), std::string::npos);
}

TEST(Job, RefusesTheTextureSpaceOfAMeshThatHasNone) {
    Scene scene = scene_of(kBall);
    Job job;
    job.texture_object = 0;
    EXPECT_EQ(faults(scene, job), "");
    scene.objects[0].shape.kind = ShapeKind::mesh;
    scene.objects[0].shape.mesh = 0;
    scene.meshes.emplace_back();
    Mesh& mesh = scene.meshes.back();
    mesh.vertices.resize(3);
    mesh.triangles = {{0, 1, 2}};
    EXPECT_NE(faults(scene, job).find("--object: error: no triangle"), std::string::npos);
    mesh.vertices[1].uv = {1, 0};
    mesh.vertices[2].uv = {0, 1};
    EXPECT_EQ(faults(scene, job), "");
    for (Vertex& vertex : mesh.vertices) vertex.uv += glm::dvec2(0, 1);
    EXPECT_NE(faults(scene, job).find("--object: error: no triangle"), std::string::npos);
}

TEST(Job, RefusesJitterInTextureSpace) {
    Job job;
    job.texture_object = 0;
    job.jitter = true;
    EXPECT_NE(faults(scene_of(kBall), job).find("--jitter"), std::string::npos);
}

class InterruptedJob : public testing::Test {
protected:
    InterruptedJob() : folder_(std::filesystem::path(testing::TempDir()) / "aftershade_interrupted_job") {
        std::filesystem::remove_all(folder_);
    }
    ~InterruptedJob() override { std::filesystem::remove_all(folder_); }

    void run(int frames_before_the_stop) {
        Diagnostics diagnostics;
        const auto profiles =
            read_profiles({std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "profiles"}, diagnostics);
        const auto native = std::find_if(profiles.begin(), profiles.end(),
                                         [](const Profile& profile) { return profile.id == "native"; });
        ASSERT_NE(native, profiles.end());
        const Scene scene = scene_of(kBall);
        Job job;
        job.folder = folder_;
        job.frames = scene.frames;
        job.width_px = job.height_px = 4;
        std::atomic<bool> stop = frames_before_the_stop == 0;
        run_job(scene, *native, job, stop, [&](int frame) { stop = frame == frames_before_the_stop; });
    }

    std::filesystem::path folder_;
};

TEST_F(InterruptedJob, NamesTheFramesThatAreThere) {
    run(2);
    std::ifstream file(folder_ / "capture.json");
    EXPECT_EQ(nlohmann::json::parse(file)["range"], "1,2");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "gbuffer_0002.exr"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "gbuffer_0003.exr"));
}

TEST_F(InterruptedJob, WritesNoDocumentOfNoFrames) {
    run(0);
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace aftershade::scene
