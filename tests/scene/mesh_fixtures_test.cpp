#include "tests/scene/gltf_file.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace aftershade::scene {
namespace {

using namespace test;

const std::filesystem::path kSourceRoot = AFTERSHADE_SOURCE_DIR;

struct Fixture {
    const char* name;
    std::size_t triangles;
    glm::dvec3 size_m;
};

/// Sizes and counts as scenes/meshes/README.md has them.
const Fixture kFixtures[] = {{"head.glb", 3936, {2.0, 1.440, 1.207}},
                             {"bat.glb", 40, {1.0, 0.32, 0.15}},
                             {"floor.glb", 2, {24, 0, 24}},
                             {"urn.glb", 2304, {0.62, 0.92, 0.62}}};

TEST(MeshFixtures, AreAsTheirReadmeSaysAndSmall) {
    for (const Fixture& fixture : kFixtures) {
        SCOPED_TRACE(fixture.name);
        const auto path = kSourceRoot / "scenes/meshes" / fixture.name;
        EXPECT_LT(std::filesystem::file_size(path), 100'000u);
        const Mesh mesh = read_gltf(path);
        EXPECT_EQ(mesh.triangles.size(), fixture.triangles);
        const Bounds bounds = mesh.bounds();
        expect_near(bounds.high - bounds.low, fixture.size_m, 0.002);
    }
}

TEST(MeshFixtures, HaveUnitNormalsOnTheSideFromWhichTheirTrianglesAreCounterClockwise) {
    for (const Fixture& fixture : kFixtures) {
        SCOPED_TRACE(fixture.name);
        const Mesh mesh = read_gltf(kSourceRoot / "scenes/meshes" / fixture.name);
        for (const Vertex& vertex : mesh.vertices) EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-12);
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            glm::dvec3 normal(0);
            for (const std::uint32_t vertex : mesh.triangles[i]) normal += mesh.vertices[vertex].normal;
            EXPECT_GT(glm::dot(normal, face_normal(mesh, i)), 0) << i;
        }
    }
}

TEST(MeshFixtures, HaveTextureCoordinatesInsideTheSquareUnlessTheirTextureRepeats) {
    for (const Fixture& fixture : kFixtures) {
        if (fixture.name == std::string("floor.glb")) continue;
        for (const Vertex& vertex : read_gltf(kSourceRoot / "scenes/meshes" / fixture.name).vertices) {
            EXPECT_GE(glm::min(vertex.uv.x, vertex.uv.y), 0) << fixture.name;
            EXPECT_LE(glm::max(vertex.uv.x, vertex.uv.y), 1) << fixture.name;
        }
    }
}

TEST(MeshFixtures, TheBatIsClosed) {
    const Mesh mesh = read_gltf(kSourceRoot / "scenes/meshes/bat.glb");
    // The volume that the triangles enclose does not depend on the point that it is measured from.
    const auto volume = [&](const glm::dvec3& from) {
        double sum = 0;
        const auto corners = corners_of(mesh);
        for (std::size_t i = 0; i < corners.size(); i += 3)
            sum += glm::dot(corners[i] - from, glm::cross(corners[i + 1] - from, corners[i + 2] - from)) / 6;
        return sum;
    };
    EXPECT_GT(volume({0, 0, 0}), 1e-4);
    EXPECT_NEAR(volume({0, 0, 0}), volume({3, -7, 11}), 1e-7);
}

}  // namespace
}  // namespace aftershade::scene
