// The shapes of bokeh: a point's light against polygons, clipped and measured independently.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "effects/bokeh/bokeh_test.h"
#include "tests/backends.h"
#include "tests/not_finite.h"
#include "tests/polygon.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test::bokeh {
namespace {

struct ShapeCase {
    const char* shape;
    const char* combine;
    int sides;      // 0: not a convex polygon, only its energy is known
    double energy;  // of an isolated point: area of the intersection or the union over one parallelogram's
    double radius_px;
    double rotation_deg;
    bool near;
};

void PrintTo(const ShapeCase& c, std::ostream* out) {
    *out << c.shape << " " << c.combine << " R " << c.radius_px << " rotation " << c.rotation_deg
         << (c.near ? " near" : " far");
}

class BokehShape : public testing::TestWithParam<ShapeCase> {};

TEST_P(BokehShape, OfABrightPointIsThePolygonWithItsEnergy) {
    const ShapeCase& c = GetParam();
    const int size = 128, center = 64;
    // At half the focus distance the radius is minus that at infinity.
    const float depth_m = c.near ? float(kFocusM / 2) : kInfinity;
    const float intensity = 1000;
    const Capture capture = make_capture({.width = size,
                                          .height = size,
                                          .background_depth_m = depth_m,
                                          .points = {{center, center, intensity}}});
    const std::string shape = fmt::format(R"({}, "shape": "{}", "combine": "{}", "rotation": {})",
                                          lens(c.radius_px, size), c.shape, c.combine, c.rotation_deg);
    const Image blurred = LookRunner(look(shape), gpu::test_backend()).color(capture);

    double energy = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) energy += blurred.at(x, y, 0) / intensity;
    EXPECT_NEAR(energy, c.energy, 0.02 * c.energy);
    if (c.sides == 0) return;
    const Image polygon =
        coverage(regular_polygon(c.sides, c.radius_px, c.rotation_deg), size, size, center, center);
    const double iou = shape_iou(blurred, blurred.at(center, center, 0), polygon);
    RecordProperty("iou", fmt::format("{:.4f}", iou));
    RecordProperty("energy", fmt::format("{:.4f}", energy));
    EXPECT_GE(iou, 0.97);
}

constexpr double kOctagonEnergy = 2 * (std::numbers::sqrt2 - 1);  // 0.828: regular octagon over its square
INSTANTIATE_TEST_SUITE_P(AtR24, BokehShape,
                         testing::Values(ShapeCase{"hexagon", "min", 6, 0.75, 24, 0, false},
                                         ShapeCase{"hexagon", "min", 6, 0.75, 24, 0, true},
                                         ShapeCase{"hexagon", "max", 0, 1.25, 24, 0, false},
                                         ShapeCase{"hexagon", "min", 6, 0.75, 24, 30, false},
                                         ShapeCase{"hexagon", "min", 6, 0.75, 24, 10, false},
                                         ShapeCase{"square", "min", 4, 1, 24, 0, false},
                                         ShapeCase{"square", "min", 4, 1, 23.5, 45, false},
                                         ShapeCase{"square", "max", 4, 1, 24, 0, true},
                                         ShapeCase{"octagon", "min", 8, kOctagonEnergy, 24, 0, false},
                                         ShapeCase{"octagon", "min", 8, kOctagonEnergy, 24, 0, true},
                                         ShapeCase{"octagon", "max", 0, 2 - kOctagonEnergy, 24, 0, false},
                                         ShapeCase{"octagon", "min", 8, kOctagonEnergy, 24, 22.5, false}));
INSTANTIATE_TEST_SUITE_P(AtR8AndR48, BokehShape,
                         testing::Values(ShapeCase{"hexagon", "min", 6, 0.75, 8, 0, false},
                                         ShapeCase{"square", "min", 4, 1, 8, 0, false},
                                         ShapeCase{"octagon", "min", 8, kOctagonEnergy, 8, 0, false},
                                         ShapeCase{"hexagon", "min", 6, 0.75, 48, 0, false},
                                         ShapeCase{"octagon", "min", 8, kOctagonEnergy, 48, 0, false}));

TEST(BokehShapeOfAParallelogram, LeansByItsSkewWithinTheCircle) {
    const int size = 128, center = 64;
    const double radius_px = 24, skew_deg = 30;
    const Capture capture = make_capture({.width = size, .height = size, .points = {{center, center, 1000}}});
    const std::string shape =
        fmt::format(R"({}, "shape": "parallelogram", "skew": {})", lens(radius_px, size), skew_deg);
    const Image blurred = LookRunner(look(shape), gpu::test_backend()).color(capture);
    // Half sides h u and h v with 60 deg between them; the longer diagonal |h (u + v)| is the circumradius.
    const double angle = (90 - skew_deg) * std::numbers::pi / 180, h = radius_px / (2 * std::cos(angle / 2));
    const double vx = h * std::cos(angle), vy = h * std::sin(angle);
    const std::vector<Vertex> corners = {{-h - vx, -vy}, {h - vx, -vy}, {h + vx, vy}, {-h + vx, vy}};
    EXPECT_NEAR(std::hypot(h + vx, vy), radius_px, 1e-9);
    const Image expected = coverage(corners, size, size, center, center);
    EXPECT_GE(shape_iou(blurred, blurred.at(center, center, 0), expected), 0.97);
}

// ---- any pair of parallelograms, and the squeeze ----

using Polygon = std::vector<Vertex>;

/// Half sides of 1; corners in the order that inside_convex takes.
Polygon parallelogram(double first_deg, double second_deg) {
    const double a = first_deg * std::numbers::pi / 180, b = second_deg * std::numbers::pi / 180;
    Vertex u{std::cos(a), std::sin(a)}, v{std::cos(b), std::sin(b)};
    if (u.x * v.y - u.y * v.x < 0) v = {-v.x, -v.y};
    return {{-u.x - v.x, -u.y - v.y}, {u.x - v.x, u.y - v.y}, {u.x + v.x, u.y + v.y}, {v.x - u.x, v.y - u.y}};
}

/// Sutherland and Hodgman: the part of `polygon` inside the convex `clip`.
Polygon clipped(Polygon polygon, const Polygon& clip) {
    for (std::size_t i = 0; i < clip.size(); ++i) {
        const Vertex a = clip[i], b = clip[(i + 1) % clip.size()];
        const auto side = [&](const Vertex& p) {
            return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        };
        Polygon kept;
        for (std::size_t j = 0; j < polygon.size(); ++j) {
            const Vertex p = polygon[j], q = polygon[(j + 1) % polygon.size()];
            const double from = side(p), to = side(q);
            if (from >= 0) kept.push_back(p);
            if (from * to >= 0) continue;
            const double t = from / (from - to);
            kept.push_back({p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t});
        }
        polygon = kept;
    }
    return polygon;
}

double area(const Polygon& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vertex &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * twice;
}

double circumradius(const Polygon& polygon) {
    double radius = 0;
    for (const Vertex& v : polygon) radius = std::max(radius, std::hypot(v.x, v.y));
    return radius;
}

Polygon scaled(Polygon polygon, double x, double y) {
    for (Vertex& v : polygon) v = {v.x * x, v.y * y};
    return polygon;
}

struct CustomCase {
    double angles_deg[4];
    bool max;
    double squeeze;
};

void PrintTo(const CustomCase& c, std::ostream* out) {
    *out << (c.max ? "max " : "min ") << c.angles_deg[0] << " " << c.angles_deg[1] << " " << c.angles_deg[2]
         << " " << c.angles_deg[3] << " squeeze " << c.squeeze;
}

std::string params_of(const CustomCase& c, double radius_px, int size) {
    return fmt::format(R"({}, "shape": "custom", "first_angle": {}, "second_angle": {}, "third_angle": {},
        "fourth_angle": {}, "combine": "{}", "squeeze": {})",
                       lens(radius_px, size), c.angles_deg[0], c.angles_deg[1], c.angles_deg[2],
                       c.angles_deg[3], c.max ? "max" : "min", c.squeeze);
}

class BokehCustomShape : public testing::TestWithParam<CustomCase> {};

TEST_P(BokehCustomShape, IsWhatItsParallelogramsHaveInCommonOrCoverWithinTheCoc) {
    const CustomCase& c = GetParam();
    const int size = 128, center = 64;
    const double radius_px = 24, intensity = 1000;
    const Capture capture =
        make_capture({.width = size, .height = size, .points = {{center, center, float(intensity)}}});
    const Image blurred = color(capture, params_of(c, radius_px, size));

    const Polygon a = parallelogram(c.angles_deg[0], c.angles_deg[1]);
    const Polygon b = parallelogram(c.angles_deg[2], c.angles_deg[3]);
    const Polygon common = clipped(a, b);
    const double outer = c.max ? std::max(circumradius(a), circumradius(b)) : circumradius(common);
    const double x = radius_px / outer * std::min(1 / c.squeeze, 1.0);
    const double y = radius_px / outer * std::min(c.squeeze, 1.0);
    Image expected = coverage(scaled(c.max ? a : common, x, y), size, size, center, center);
    if (c.max) {
        const Image other = coverage(scaled(b, x, y), size, size, center, center);
        for (std::size_t i = 0; i < other.floats().size(); ++i)
            expected.floats()[i] = std::max(expected.floats()[i], other.floats()[i]);
    }
    const double iou = shape_iou(blurred, blurred.at(center, center, 0), expected);
    RecordProperty("iou", fmt::format("{:.4f}", iou));
    EXPECT_GE(iou, 0.97);

    double energy = 0;
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) energy += blurred.at(i, j, 0) / intensity;
    const double kept = area(common) / std::max(area(a), area(b));
    if (!c.max) {
        // Blurs along two oblique lines ripple by some percent, and the minimum keeps the least.
        EXPECT_NEAR(energy, kept, 0.06 * kept);
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, BokehCustomShape,
    testing::Values(CustomCase{{0, 90, 45, 135}, false, 1}, CustomCase{{90, 30, 90, 150}, false, 1},
                    CustomCase{{0, 90, 30, 120}, false, 1}, CustomCase{{10, 80, 60, 150}, false, 1},
                    CustomCase{{0, 90, 20, 65}, false, 1}, CustomCase{{0, -45, 0, 45}, true, 1},
                    CustomCase{{0, 90, 45, 135}, true, 1}, CustomCase{{0, 60, 0, -60}, false, 2},
                    CustomCase{{15, 100, 60, 140}, false, 0.5}));

struct SqueezeCase {
    const char* shape;
    int sides;
    double squeeze, rotation_deg;
};

class BokehSqueeze : public testing::TestWithParam<SqueezeCase> {};

TEST_P(BokehSqueeze, IsTheShapesHeightOverItsWidth) {
    const SqueezeCase& c = GetParam();
    const int size = 128, center = 64;
    const double radius_px = 32;
    const Capture capture = make_capture({.width = size, .height = size, .points = {{center, center, 1000}}});
    const Image blurred =
        color(capture, fmt::format(R"({}, "shape": "{}", "rotation": {}, "squeeze": {})",
                                   lens(radius_px, size), c.shape, c.rotation_deg, c.squeeze));
    const Polygon polygon = scaled(regular_polygon(c.sides, radius_px, c.rotation_deg),
                                   std::min(1 / c.squeeze, 1.0), std::min(c.squeeze, 1.0));
    const Image expected = coverage(polygon, size, size, center, center);
    const double iou = shape_iou(blurred, blurred.at(center, center, 0), expected);
    RecordProperty("iou", fmt::format("{:.4f}", iou));
    EXPECT_GE(iou, 0.97) << c.shape << " " << c.squeeze;
}

INSTANTIATE_TEST_SUITE_P(All, BokehSqueeze,
                         testing::Values(SqueezeCase{"hexagon", 6, 2, 0}, SqueezeCase{"hexagon", 6, 0.5, 15},
                                         SqueezeCase{"octagon", 8, 1.33, 0},
                                         SqueezeCase{"octagon", 8, 0.75, 20}, SqueezeCase{"square", 4, 2, 0},
                                         SqueezeCase{"hexagon", 6, 3, 30}));

// ---- energy that the minimum takes, given back ----

struct GainCase {
    const char* params;
    double radius_px;
    bool near;
};

class BokehHighlightGain : public testing::TestWithParam<GainCase> {};

TEST_P(BokehHighlightGain, GivesAnIsolatedPointItsEnergy) {
    const GainCase& c = GetParam();
    const int size = 128, center = 64;
    const Capture capture = make_capture({.width = size,
                                          .height = size,
                                          .background_depth_m = c.near ? float(kFocusM / 2) : kInfinity,
                                          .points = {{center, center, 1000}}});
    const Image out =
        color(capture, fmt::format(R"({}, {}, "highlight_gain": 1)", lens(c.radius_px, size), c.params));
    double energy = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) energy += out.at(x, y, 0) / 1000;
    RecordProperty("energy", fmt::format("{:.4f}", energy));
    EXPECT_NEAR(energy, 1, 0.02) << c.params << " R " << c.radius_px;
}

constexpr const char* kUneven =
    R"("shape": "custom", "first_angle": 10, "second_angle": 80, "third_angle": 60,
    "fourth_angle": 150)";
INSTANTIATE_TEST_SUITE_P(
    All, BokehHighlightGain,
    testing::Values(GainCase{R"("shape": "hexagon")", 24, false}, GainCase{R"("shape": "hexagon")", 24, true},
                    GainCase{R"("shape": "hexagon")", 8, false}, GainCase{R"("shape": "hexagon")", 48, false},
                    GainCase{R"("shape": "octagon")", 24, false}, GainCase{R"("shape": "square")", 24, false},
                    GainCase{kUneven, 24, false}));

TEST(BokehHighlightGain, LeavesLightThatIsNoHighlightAlone) {
    // A wide wall, three times as bright as the rest.
    const SyntheticBox wall{
        .x = 30, .y = 0, .width = 60, .height = 96, .depth_m = kInfinity, .color = {3, 3, 3}};
    const Capture capture =
        make_capture({.width = 120, .height = 96, .background = {1, 1, 1}, .box = wall}, 0);
    const Image without = color(capture, lens(12, 120));
    const Image with = color(capture, lens(12, 120) + R"(, "highlight_gain": 1)");
    EXPECT_TRUE(std::equal(with.floats().begin(), with.floats().end(), without.floats().begin()));
}

TEST(BokehHighlightGain, LeavesAHighlightInFocusAloneBitForBit) {
    const Capture capture = make_capture(
        {.width = 64, .height = 36, .background_depth_m = float(kFocusM), .points = {{20, 20, 1e4f}}});
    const Image out = color(capture, lens(20, 64) + R"(, "highlight_gain": 1)");
    const auto expected = capture.images.at("color").floats();
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), out.floats().begin()));
}

}  // namespace
}  // namespace aftershade::test::bokeh
