#include "framework/scene/mesh.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace aftershade::scene {
namespace {

const std::vector<Wave> kWaves = {{0.05, {1.5, 0}, 0.3}, {0.02, {0.7, -2.1}, -1.2}, {0.1, {0, 0.25}, 2}};

double height(double x, double y) {
    double z = 0;
    for (const Wave& wave : kWaves)
        z += wave.amplitude_m *
             std::cos(2 * std::numbers::pi * (x * wave.cycles_per_m.x + y * wave.cycles_per_m.y) +
                      wave.phase_rad);
    return z;
}

TEST(HeightField, NormalsAreThoseOfFiniteDifferences) {
    constexpr double kStep = 1e-5;
    const Mesh mesh = make_height_field({3, 2}, kWaves, 24);
    for (const Vertex& vertex : mesh.vertices) {
        const glm::dvec3& p = vertex.position;
        EXPECT_NEAR(p.z, height(p.x, p.y), 1e-15);
        const double dx = (height(p.x + kStep, p.y) - height(p.x - kStep, p.y)) / (2 * kStep);
        const double dy = (height(p.x, p.y + kStep) - height(p.x, p.y - kStep)) / (2 * kStep);
        const glm::dvec3 expected = glm::normalize(glm::cross(glm::dvec3(1, 0, dx), glm::dvec3(0, 1, dy)));
        EXPECT_LT(glm::length(vertex.normal - expected), 1e-8);
        EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-14);
    }
}

TEST(HeightField, CoversItsRectangleOnceWithTrianglesThatFaceUp) {
    const Mesh mesh = make_height_field({3, 2}, kWaves, 7);
    EXPECT_EQ(mesh.vertices.size(), 64u);
    ASSERT_EQ(mesh.triangles.size(), 98u);
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const glm::dvec3 cross = glm::cross(mesh.vertices[b].position - mesh.vertices[a].position,
                                            mesh.vertices[c].position - mesh.vertices[a].position);
        EXPECT_GT(cross.z, 0);
        area += cross.z / 2;  // as seen along z
    }
    EXPECT_NEAR(area, 6, 1e-12);
    EXPECT_EQ(mesh.bounds().low.x, -1.5);
    EXPECT_EQ(mesh.bounds().high.x, 1.5);
    EXPECT_EQ(mesh.bounds().low.y, -1);
    EXPECT_EQ(mesh.bounds().high.y, 1);
}

TEST(HeightField, HasTheTextureCoordinatesOfAPlane) {
    for (const Vertex& vertex : make_height_field({3, 2}, kWaves, 5).vertices) {
        EXPECT_NEAR(vertex.uv.x, vertex.position.x / 3 + 0.5, 1e-15);
        EXPECT_NEAR(vertex.uv.y, 0.5 - vertex.position.y / 2, 1e-15);
    }
}

TEST(HeightField, IsFlatWithoutWaves) {
    const Mesh mesh = make_height_field({1, 1}, {}, 1);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    for (const Vertex& vertex : mesh.vertices) {
        EXPECT_EQ(vertex.position.z, 0);
        EXPECT_EQ(vertex.normal, glm::dvec3(0, 0, 1));
    }
}

}  // namespace
}  // namespace aftershade::scene
