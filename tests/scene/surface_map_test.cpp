#include "framework/scene/surface_map.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

namespace aftershade::scene {
namespace {

double fract(double x) {
    return x - std::floor(x);
}

/// The face's cell, and where in it, as surface_map.h's table has it.
glm::dvec2 box_uv(const glm::dvec3& p, const glm::dvec3& n, const glm::dvec3& h) {
    const double x = p.x / (2 * h.x);
    const double y = p.y / (2 * h.y);
    const double z = p.z / (2 * h.z);
    const auto cell = [](int column, int row, double a, double b) {
        return glm::dvec2((column + a) / 3, (row + b) / 2);
    };
    if (std::abs(n.x) > 0.5) return n.x > 0 ? cell(0, 0, 0.5 - z, 0.5 - y) : cell(1, 0, 0.5 + z, 0.5 - y);
    if (std::abs(n.y) > 0.5) return n.y > 0 ? cell(2, 0, 0.5 + x, 0.5 + z) : cell(0, 1, 0.5 + x, 0.5 - z);
    return n.z > 0 ? cell(1, 1, 0.5 + x, 0.5 - y) : cell(2, 1, 0.5 - x, 0.5 - y);
}

glm::dvec2 cylinder_uv(const glm::dvec3& p, const glm::dvec3& n, const glm::dvec3& h) {
    if (std::abs(n.y) < 0.5)
        return {fract(std::atan2(p.z, p.x) / (2 * std::numbers::pi)), (2.0 / 3) * (0.5 - p.y / (2 * h.y))};
    if (n.y > 0) return {(0.5 + p.x / (2 * h.x)) / 2, (2 + 0.5 + p.z / (2 * h.x)) / 3};
    return {(1 + 0.5 + p.x / (2 * h.x)) / 2, (2 + 0.5 - p.z / (2 * h.x)) / 3};
}

/// The table of surface_map.h, the other way than make_surface_map goes.
glm::dvec2 uv_of(const Shape& shape, const glm::dvec3& p, const glm::dvec3& n) {
    const glm::dvec3& h = shape.half_size_m;
    switch (shape.kind) {
        case ShapeKind::plane: return {0.5 + p.x / (2 * h.x), 0.5 - p.y / (2 * h.y)};
        case ShapeKind::disk: return {0.5 + p.x / (2 * h.x), 0.5 - p.y / (2 * h.x)};
        case ShapeKind::sphere:
            return {fract(std::atan2(p.z, p.x) / (2 * std::numbers::pi)),
                    std::acos(glm::clamp(p.y / h.x, -1.0, 1.0)) / std::numbers::pi};
        case ShapeKind::box: return box_uv(p, n, h);
        case ShapeKind::cylinder: return cylinder_uv(p, n, h);
        default: return {-1, -1};
    }
}

glm::dvec3 xyz(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

struct Texel {
    int x;
    int y;
    glm::dvec2 uv;
    glm::dvec3 position;
    glm::dvec3 normal;
};

/// Visits the covered texels, whose number it returns; the others must be all zero.
int for_covered(const SurfaceMap& map, const std::function<void(const Texel&)>& visit) {
    int covered = 0;
    const int side_px = map.position.width();
    for (int y = 0; y < side_px; ++y)
        for (int x = 0; x < side_px; ++x) {
            const glm::dvec3 position = xyz(map.position, x, y);
            const glm::dvec3 normal = xyz(map.normal, x, y);
            EXPECT_EQ(map.position.at(x, y, 3), map.normal.at(x, y, 3));
            if (map.position.at(x, y, 3) == 0) {
                EXPECT_EQ(position, glm::dvec3(0));
                EXPECT_EQ(normal, glm::dvec3(0));
                continue;
            }
            ++covered;
            EXPECT_EQ(map.position.at(x, y, 3), 1);
            EXPECT_NEAR(glm::length(normal), 1, 1e-6);
            visit({x, y, (glm::dvec2(x, y) + 0.5) / double(side_px), position, normal});
        }
    return covered;
}

struct ShapeCase {
    const char* name;
    Shape shape;
    double covered;  ///< part of the unit square
    /// How far a point is off the surface, m.
    std::function<double(const glm::dvec3&, const glm::dvec3&)> distance;
};

const glm::dvec3 kHalf(0.7, 1.1, 0.4);

std::vector<ShapeCase> shape_cases() {
    const auto off_z = [](const glm::dvec3& p, const glm::dvec3& n) {
        return std::abs(p.z) + glm::length(n - glm::dvec3(0, 0, 1));
    };
    const auto off_sphere = [](const glm::dvec3& p, const glm::dvec3& n) {
        return std::abs(glm::length(p) - kHalf.x) + glm::length(n - glm::normalize(p));
    };
    const auto off_box = [](const glm::dvec3& p, const glm::dvec3& n) {
        const glm::dvec3 q = glm::abs(p) - kHalf;
        return std::abs(glm::max(q.x, glm::max(q.y, q.z))) +
               std::abs(glm::dot(p, n) - glm::dot(kHalf, glm::abs(n)));
    };
    const auto off_cylinder = [](const glm::dvec3& p, const glm::dvec3& n) {
        const double radius = std::hypot(p.x, p.z);
        if (std::abs(n.y) < 0.5)
            return std::abs(radius - kHalf.x) + std::max(std::abs(p.y) - kHalf.y, 0.0) +
                   glm::length(n - glm::dvec3(p.x, 0, p.z) / radius);
        return std::abs(p.y - n.y * kHalf.y) + std::max(radius - kHalf.x, 0.0);
    };
    return {{"plane", {ShapeKind::plane, kHalf}, 1, off_z},
            {"disk", {ShapeKind::disk, kHalf}, std::numbers::pi / 4, off_z},
            {"sphere", {ShapeKind::sphere, kHalf}, 1, off_sphere},
            {"box", {ShapeKind::box, kHalf}, 1, off_box},
            {"cylinder", {ShapeKind::cylinder, kHalf}, 2.0 / 3 + std::numbers::pi / 4 / 3, off_cylinder}};
}

TEST(SurfaceMap, TheTableLeadsFromEachPointBackToItsTexelsCentre) {
    for (const ShapeCase& test : shape_cases())
        for (const int side_px : {1, 7, 96}) {
            SCOPED_TRACE(std::string(test.name) + " " + std::to_string(side_px));
            for_covered(make_surface_map(test.shape, nullptr, side_px), [&](const Texel& texel) {
                const glm::dvec2 uv = uv_of(test.shape, texel.position, texel.normal);
                EXPECT_NEAR(uv.x, texel.uv.x, 2e-5) << texel.x << " " << texel.y;  // near the poles of floats
                EXPECT_NEAR(uv.y, texel.uv.y, 2e-5) << texel.x << " " << texel.y;
            });
        }
}

TEST(SurfaceMap, ItsPointsLieOnTheSurfaceAndItsNormalsPointOut) {
    for (const ShapeCase& test : shape_cases()) {
        SCOPED_TRACE(test.name);
        const int covered = for_covered(make_surface_map(test.shape, nullptr, 120), [&](const Texel& texel) {
            EXPECT_LT(test.distance(texel.position, texel.normal), 1e-6) << texel.x << " " << texel.y;
        });
        EXPECT_NEAR(covered / (120.0 * 120), test.covered, 0.003);
    }
}

/// Which way (dp/du x dp/dv) . n points, from texels beside one another on one face.
double handedness(const SurfaceMap& map, int x, int y) {
    const glm::dvec3 right = xyz(map.position, x + 1, y) - xyz(map.position, x, y);
    const glm::dvec3 down = xyz(map.position, x, y + 1) - xyz(map.position, x, y);
    return glm::dot(glm::cross(right, -down), xyz(map.normal, x, y));
}

TEST(SurfaceMap, FlatFacesAreNotMirrored) {
    const SurfaceMap plane = make_surface_map({ShapeKind::plane, kHalf}, nullptr, 12);
    EXPECT_GT(handedness(plane, 5, 5), 0);
    const SurfaceMap box = make_surface_map({ShapeKind::box, kHalf}, nullptr, 24);
    for (const int x : {4, 12, 20})
        for (const int y : {6, 18}) EXPECT_GT(handedness(box, x, y), 0) << x << " " << y;
    const SurfaceMap cylinder = make_surface_map({ShapeKind::cylinder, kHalf}, nullptr, 24);
    EXPECT_GT(handedness(cylinder, 6, 20), 0);
    EXPECT_GT(handedness(cylinder, 18, 20), 0);
}

TEST(SurfaceMap, BoxAndCylinderShowEachFaceWhereTheTableSays) {
    const SurfaceMap box = make_surface_map({ShapeKind::box, kHalf}, nullptr, 6);
    const glm::dvec3 faces[2][3] = {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}}, {{0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 6; ++x) EXPECT_EQ(xyz(box.normal, x, y), faces[y / 3][x / 2]) << x << " " << y;
    const SurfaceMap cylinder = make_surface_map({ShapeKind::cylinder, kHalf}, nullptr, 12);
    EXPECT_EQ(xyz(cylinder.normal, 3, 10), glm::dvec3(0, 1, 0));
    EXPECT_EQ(xyz(cylinder.normal, 8, 10), glm::dvec3(0, -1, 0));
    EXPECT_EQ(cylinder.position.at(0, 8, 3), 0) << "the corner of a cap's cell lies outside its disk";
    EXPECT_GT(cylinder.position.at(3, 0, 1), cylinder.position.at(3, 7, 1))
        << "the top of the side comes first";
}

TEST(SurfaceMap, AGroupCoversNothing) {
    EXPECT_EQ(for_covered(make_surface_map({ShapeKind::group}, nullptr, 4), [](const Texel&) {}), 0);
}

Mesh quad(const glm::dvec3& origin, const glm::dvec2& low, const glm::dvec2& high) {
    Mesh mesh;
    for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)})
        mesh.vertices.push_back({origin + glm::dvec3(corner, 0), {0, 0, 1}, low + corner * (high - low)});
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

const Shape kMeshShape{ShapeKind::mesh, {}, 0};

TEST(SurfaceMap, AMeshsTrianglesLeaveNoGapAlongTheirSharedEdges) {
    // Every shared diagonal of every square passes through texel centres.
    const Mesh field = make_height_field({2, 2}, {}, 8);
    for (const int side_px : {16, 61, 64, 96}) {
        const SurfaceMap map = make_surface_map(kMeshShape, &field, side_px);
        const int covered = for_covered(map, [&](const Texel& texel) {
            EXPECT_NEAR(texel.position.x, 2 * texel.uv.x - 1, 1e-6);
            EXPECT_NEAR(texel.position.y, 1 - 2 * texel.uv.y, 1e-6);
        });
        EXPECT_EQ(covered, side_px * side_px);
    }
}

TEST(SurfaceMap, AMeshsPositionAndNormalAreInterpolatedBetweenItsCorners) {
    const std::vector<Wave> waves = {{0.1, {1, 0.5}, 0.4}};
    const Mesh coarse = make_height_field({2, 2}, waves, 64);
    // f'' h^2 / 8 along the diagonal of a square of 1/32 m, where the phase turns by 1.5 cycles a metre.
    const double sagitta_m = 1.01 * 0.1 * std::pow(2 * std::numbers::pi * 1.5 / 32, 2) / 8;
    for_covered(make_surface_map(kMeshShape, &coarse, 50), [&](const Texel& texel) {
        const double phase = 2 * std::numbers::pi * (texel.position.x + 0.5 * texel.position.y) + 0.4;
        EXPECT_NEAR(texel.position.z, 0.1 * std::cos(phase), sagitta_m);
        const double slope = -0.1 * 2 * std::numbers::pi * std::sin(phase);
        EXPECT_LT(glm::length(texel.normal - glm::normalize(glm::dvec3(-slope, -0.5 * slope, 1))), 0.01);
    });
}

TEST(SurfaceMap, OnlyTexelsInsideAMeshsTrianglesAreCovered) {
    const Mesh mesh = quad({0, 0, 0}, {0.25, 0.5}, {0.75, 1.5});  // the lower half lies outside the square
    const int covered = for_covered(make_surface_map(kMeshShape, &mesh, 16), [](const Texel& texel) {
        EXPECT_TRUE(texel.x >= 4 && texel.x < 12 && texel.y >= 8) << texel.x << " " << texel.y;
    });
    EXPECT_EQ(covered, 8 * 8);
}

TEST(SurfaceMap, TheLowestTriangleWinsWhereTrianglesOverlapEvenMirrored) {
    Mesh mesh = quad({0, 0, 3}, {0, 0}, {1, 1});
    const Mesh over = quad({0, 0, 5}, {1, 0}, {0, 1});  // u mirrored: clockwise in the texture
    for (const Vertex& vertex : over.vertices) mesh.vertices.push_back(vertex);
    mesh.triangles.insert(mesh.triangles.begin(), {{4, 5, 6}, {4, 6, 7}});
    const int covered = for_covered(make_surface_map(kMeshShape, &mesh, 9), [](const Texel& texel) {
        EXPECT_EQ(texel.position.z, 5);
        EXPECT_NEAR(texel.position.x, 1 - texel.uv.x, 1e-6);
    });
    EXPECT_EQ(covered, 81);
}

TEST(SurfaceMap, AMeshWithoutTextureCoordinatesCoversNothing) {
    Mesh mesh = quad({0, 0, 0}, {0, 0}, {0, 0});
    EXPECT_EQ(for_covered(make_surface_map(kMeshShape, &mesh, 8), [](const Texel&) {}), 0);
}

}  // namespace
}  // namespace aftershade::scene
