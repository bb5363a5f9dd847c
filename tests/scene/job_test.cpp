// A whole job: what it refuses, memory, stopping, the files that appear.
#include "framework/scene/job.h"

#include <unistd.h>

#include <atomic>
#include <fstream>

#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "framework/capture/sequence.h"
#include "tests/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace aftershade::scene {
namespace {

Profile native_profile() {
    Diagnostics diagnostics;
    for (Profile& profile :
         read_profiles(std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "profiles", diagnostics))
        if (profile.id == "native") return std::move(profile);
    throw std::runtime_error("no native profile");
}

Job small_job(const std::filesystem::path& folder, std::vector<int> frames) {
    Job job;
    job.folder = folder;
    job.frames = std::move(frames);
    job.width_px = 48;
    job.height_px = 27;
    job.threads = 2;
    return job;
}

double resident_kib() {
    std::ifstream statm("/proc/self/statm");
    double pages = 0, resident = 0;
    statm >> pages >> resident;
    return resident * double(sysconf(_SC_PAGESIZE)) / 1024;
}

TEST(Job, KeepsItsMemoryLevelFromFrame2To200) {
    const Scene scene = shipped_scene("wheel");
    test::TemporaryFolder folder;
    std::vector<int> frames(200);
    for (int i = 0; i < 200; ++i) frames[std::size_t(i)] = i + 1;
    const std::atomic<bool> stop = false;
    double early_kib = 0, late_kib = 0;
    Job job = small_job(folder / "capture", frames);
    job.truths = {*parse_truth("shutter")};
    job.samples = 2;
    run_job(scene, native_profile(), job, stop, [&](int frame) {
        if (frame == 2) early_kib = resident_kib();
        if (frame == 200) late_kib = resident_kib();
    });
    RecordProperty("growth_kib", int(late_kib - early_kib));
    // A frame of these is 150 kB: 198 that stayed would be 30 MB.
    EXPECT_LT(late_kib - early_kib, 2048);
}

TEST(Job, EndsBetweenFramesWithWholeFiles) {
    const Scene scene = shipped_scene("wheel");
    test::TemporaryFolder folder;
    std::atomic<bool> stop = false;
    const JobReport report = run_job(scene, native_profile(), small_job(folder / "capture", {1, 2, 3, 4}),
                                     stop, [&](int frame) { stop = frame == 2; });
    EXPECT_EQ(report.frames, 2);
    Diagnostics diagnostics;
    const auto sequence = open_sequence((folder / "capture").string(), diagnostics);
    ASSERT_TRUE(sequence);
    // The document names what the folder holds.
    EXPECT_EQ(sequence->frames, (std::vector<int>{1, 2}));
    for (const auto& entry : std::filesystem::directory_iterator(folder / "capture"))
        EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
}

TEST(Job, ToldWhatItCannotDoBeforeItBegins) {
    Scene scene = shipped_scene("wheel");
    Job job = small_job("nowhere", {1});
    Diagnostics none;
    check_job(scene, job, none);
    EXPECT_FALSE(none.has_errors());
    scene.camera.shutter_angle_deg = 0;
    job.truths = {*parse_truth("scattering"), *parse_truth("lens+shutter")};
    job.scattering_samples = 10;
    job.texture_object = 0;
    job.subframes = 4;
    Diagnostics diagnostics;
    check_job(scene, job, diagnostics);
    // No profile, too few points, a shutter that never opens, no sub-frames and no truth in texture space.
    EXPECT_EQ(diagnostics.error_count(), 5) << faults_of(diagnostics);
}

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
    EXPECT_NE(faults(scene, job).find("subframes: error: file numbers"), std::string::npos);
    job.frames = {-999999999};
    EXPECT_NE(faults(scene, job).find("subframes: error: file numbers"), std::string::npos);
}

TEST(Job, CountsTheLightThatItKeeps) {
    const Scene scene = scene_of(kBall);
    Job job;
    job.captures = false;
    job.width_px = job.height_px = 4096;
    job.visibility.emplace();
    job.visibility->samples = 8;
    EXPECT_EQ(faults(scene, job), "");
    job.visibility->keep_shading = true;
    const std::string text = faults(scene, job);
    EXPECT_NE(text.find("the limit is 16 GiB (render fewer pixels at once, or choose a lower shading_rate)"),
              std::string::npos)
        << text;
}

TEST(Job, RefusesAFolderWithoutAName) {
    Diagnostics diagnostics;
    check_job(scene_of(kBall), Job{}, diagnostics);
    EXPECT_NE(faults_of(diagnostics).find("path: error: names no folder"), std::string::npos);
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
    EXPECT_NE(faults(scene, job).find("object: error: no triangle"), std::string::npos);
    mesh.vertices[1].uv = {1, 0};
    mesh.vertices[2].uv = {0, 1};
    EXPECT_EQ(faults(scene, job), "");
    for (Vertex& vertex : mesh.vertices) vertex.uv += glm::dvec2(0, 1);
    EXPECT_NE(faults(scene, job).find("object: error: no triangle"), std::string::npos);
}

TEST(Job, RefusesJitterInTextureSpace) {
    Job job;
    job.texture_object = 0;
    job.jitter = true;
    EXPECT_NE(faults(scene_of(kBall), job).find("jitter: error: "), std::string::npos);
}

TEST(Job, WritesNoDocumentOfNoFrames) {
    test::TemporaryFolder folder;
    const std::atomic<bool> stop = true;
    const Scene scene = scene_of(kBall);
    run_job(scene, native_profile(), small_job(folder / "capture", {1}), stop, [](int) {});
    EXPECT_TRUE(std::filesystem::is_empty(folder / "capture"));
}

}  // namespace
}  // namespace aftershade::scene
