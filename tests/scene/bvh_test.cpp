#include "framework/scene/mesh.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace aftershade::scene {
namespace {

struct TestRay {
    glm::dvec3 origin;
    glm::dvec3 direction;
};

using Triangle = std::array<glm::dvec3, 3>;

Bounds bounds_of(const Triangle& triangle) {
    Bounds bounds;
    for (const glm::dvec3& corner : triangle) bounds.add(corner);
    return bounds;
}

bool hits(const TestRay& ray, const Bounds& box) {
    double enter = 0;
    double leave = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        if (d == 0) {
            if (ray.origin[axis] < box.low[axis] || ray.origin[axis] > box.high[axis]) return false;
            continue;
        }
        const double a = (box.low[axis] - ray.origin[axis]) / d;
        const double b = (box.high[axis] - ray.origin[axis]) / d;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * (1 + 1e-12) + 1e-12;
}

/// Moeller and Trumbore 1997.
bool hits(const TestRay& ray, const Triangle& triangle) {
    const glm::dvec3 edge_1 = triangle[1] - triangle[0];
    const glm::dvec3 edge_2 = triangle[2] - triangle[0];
    const glm::dvec3 p = glm::cross(ray.direction, edge_2);
    const double determinant = glm::dot(edge_1, p);
    if (determinant == 0) return false;
    const glm::dvec3 from_corner = ray.origin - triangle[0];
    const double u = glm::dot(from_corner, p) / determinant;
    const glm::dvec3 q = glm::cross(from_corner, edge_1);
    const double v = glm::dot(ray.direction, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && glm::dot(edge_2, q) / determinant >= 0;
}

/// The traversal that mesh.h describes. Counts its steps, so that a loop of skips fails instead of hanging.
std::set<std::uint32_t> found_by_tree(const TestRay& ray, const Bvh& bvh,
                                      const std::vector<Triangle>& triangles) {
    std::set<std::uint32_t> found;
    std::size_t steps = 0;
    for (std::uint32_t node = 0; node < bvh.nodes.size(); ++steps) {
        EXPECT_LE(steps, bvh.nodes.size());
        if (steps > bvh.nodes.size()) break;
        const BvhNode& at = bvh.nodes[node];
        const bool inside = hits(ray, at.bounds);
        for (std::uint32_t i = 0; inside && i < at.count; ++i) {
            const std::uint32_t item = bvh.items[at.first + i];
            if (hits(ray, triangles[item])) found.insert(item);
        }
        node = inside && at.count == 0 ? node + 1 : at.skip;
    }
    return found;
}

class Soup {
public:
    explicit Soup(unsigned seed) : random_(seed) {}
    double number(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    glm::dvec3 point(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
    std::vector<Triangle> triangles(int count, double size) {
        std::vector<Triangle> triangles;
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 centre = point(5);
            triangles.push_back({centre + point(size), centre + point(size), centre + point(size)});
        }
        return triangles;
    }

private:
    std::mt19937 random_;
};

std::vector<Bounds> boxes_of(const std::vector<Triangle>& triangles) {
    std::vector<Bounds> boxes;
    for (const Triangle& triangle : triangles) boxes.push_back(bounds_of(triangle));
    return boxes;
}

bool contains(const Bounds& outer, const Bounds& inner) {
    return glm::all(glm::lessThanEqual(outer.low, inner.low)) &&
           glm::all(glm::greaterThanEqual(outer.high, inner.high));
}

/// Everything that a traversal relies on, of the subtree at `node`; adds its items to `seen`. Its depth.
int check_subtree(const Bvh& bvh, const std::vector<Bounds>& boxes, std::uint32_t node, int leaf_size,
                  std::vector<int>& seen) {
    const BvhNode& at = bvh.nodes[node];
    EXPECT_GT(at.skip, node);
    EXPECT_LE(at.skip, bvh.nodes.size());
    EXPECT_LE(at.count, std::uint32_t(leaf_size));
    if (at.count > 0) {
        EXPECT_EQ(at.skip, node + 1) << "a leaf has nothing below it";
        for (std::uint32_t i = at.first; i < at.first + at.count; ++i) {
            ++seen[bvh.items[i]];
            EXPECT_TRUE(contains(at.bounds, boxes[bvh.items[i]]));
        }
        return 1;
    }
    int depth = 0;
    std::uint32_t child = node + 1;
    int children = 0;
    for (; child < at.skip; child = bvh.nodes[child].skip, ++children) {
        EXPECT_TRUE(contains(at.bounds, bvh.nodes[child].bounds));
        depth = std::max(depth, check_subtree(bvh, boxes, child, leaf_size, seen));
    }
    EXPECT_EQ(children, 2);
    EXPECT_EQ(child, at.skip) << "the last child ends where its parent does";
    return depth + 1;
}

void check_tree(const std::vector<Bounds>& boxes, int leaf_size) {
    const Bvh bvh = build_bvh(boxes, leaf_size);
    ASSERT_FALSE(bvh.nodes.empty());
    EXPECT_EQ(bvh.nodes[0].skip, bvh.nodes.size());
    ASSERT_EQ(bvh.items.size(), boxes.size());
    std::vector<int> seen(boxes.size());
    const int depth = check_subtree(bvh, boxes, 0, leaf_size, seen);
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }))
        << "each item stands in exactly one leaf";
    EXPECT_LE(depth, int(std::ceil(std::log2(double(boxes.size())))) + 1) << "medians keep it balanced";
}

TEST(Bvh, FindsEveryTriangleThatBruteForceFinds) {
    Soup soup(7);
    for (const auto& [count, size, leaf_size] :
         {std::tuple(1, 3.0, 4), {2, 3.0, 1}, {17, 3.0, 3}, {300, 2.0, 1}, {1000, 0.8, 4}}) {
        const auto triangles = soup.triangles(count, size);
        const Bvh bvh = build_bvh(boxes_of(triangles), leaf_size);
        std::size_t total = 0;
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 origin = soup.point(8);
            const Triangle& aim = triangles[std::size_t(i % count)];
            const glm::dvec3 target = (aim[0] + aim[1] + aim[2]) / 3.0 + soup.point(0.5);
            TestRay ray{origin, glm::normalize(target - origin)};
            if (i % 10 == 0) ray = {target + glm::dvec3(0, 9, 0), {0, -1, 0}};
            std::set<std::uint32_t> expected;
            for (std::uint32_t t = 0; t < triangles.size(); ++t)
                if (hits(ray, triangles[t])) expected.insert(t);
            EXPECT_EQ(found_by_tree(ray, bvh, triangles), expected);
            total += expected.size();
        }
        EXPECT_GT(total, 0u) << count << " triangles, and no ray hits any";
    }
}

TEST(Bvh, FindsTrianglesWhoseBoxesHaveNoThickness) {
    Soup soup(11);
    std::vector<Triangle> triangles;
    for (int i = 0; i < 200; ++i) {
        const double z = std::floor(soup.number(-4, 4));
        const glm::dvec3 centre(soup.number(-5, 5), soup.number(-5, 5), z);
        triangles.push_back({centre, centre + glm::dvec3(1, 0, 0), centre + glm::dvec3(0, 1, 0)});
    }
    const Bvh bvh = build_bvh(boxes_of(triangles), 2);
    std::size_t total = 0;
    for (int i = 0; i < 300; ++i) {
        const TestRay ray{{soup.number(-5, 6), soup.number(-5, 6), 9}, {0, 0, -1}};
        std::set<std::uint32_t> expected;
        for (std::uint32_t t = 0; t < triangles.size(); ++t)
            if (hits(ray, triangles[t])) expected.insert(t);
        EXPECT_EQ(found_by_tree(ray, bvh, triangles), expected);
        total += expected.size();
    }
    EXPECT_GT(total, 100u);
}

TEST(Bvh, PutsEachItemInExactlyOneLeafInsideTheBoxesAboveIt) {
    Soup soup(3);
    for (const int count : {1, 2, 3, 4, 5, 8, 9, 63, 64, 65, 500})
        for (const int leaf_size : {1, 2, 4, 16}) check_tree(boxes_of(soup.triangles(count, 1)), leaf_size);
}

TEST(Bvh, SplitsItemsWhoseCentresAreEqual) {
    Bounds box;
    box.add({-1, -1, -1});
    box.add({1, 1, 1});
    check_tree(std::vector<Bounds>(37, box), 4);
    Bounds point;
    point.add({2, 2, 2});
    check_tree(std::vector<Bounds>(9, point), 1);
}

TEST(Bvh, OfNothingHasNoNodes) {
    const Bvh bvh = build_bvh({}, 4);
    EXPECT_TRUE(bvh.nodes.empty());
    EXPECT_TRUE(bvh.items.empty());
}

TEST(Bvh, SplitsAtTheMedianOfTheLongestSide) {
    std::vector<Bounds> boxes;
    for (const double y : {6.0, 0.0, 4.0, 2.0}) {
        Bounds box;
        box.add({y == 4 ? 1 : 0, y, 0});
        boxes.push_back(box);
    }
    const Bvh bvh = build_bvh(boxes, 2);
    ASSERT_EQ(bvh.nodes.size(), 3u);
    EXPECT_EQ(bvh.items, (std::vector<std::uint32_t>{1, 3, 0, 2}));
    EXPECT_EQ(bvh.nodes[1].bounds.high.y, 2);
    EXPECT_EQ(bvh.nodes[2].bounds.low.y, 4);
}

}  // namespace
}  // namespace aftershade::scene
