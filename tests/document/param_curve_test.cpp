#include <algorithm>
#include <cmath>
#include <random>

#include "tests/document/param_specs.h"

namespace aftershade {
namespace {

using test::Lines;
using test::spec_of;
using test::value_faults;
using test::value_of;

const std::string kFalloff =
    R"({"type": "curve", "unit": "px", "domain": [-1, 2], "default": [[0, 0], [1, 8]],
    "min": 0, "max": 10, "doc": "."})";

CurveValue curve_of(const std::string& text) {
    return std::get<CurveValue>(value_of(spec_of(kFalloff), text));
}

TEST(Curve, KeepsItsDomainUnitAndDefault) {
    const ParamSpec spec = spec_of(kFalloff);
    EXPECT_EQ(spec.type, ParamType::curve);
    EXPECT_EQ(spec.unit, "px");
    EXPECT_EQ(spec.domain, (std::array<double, 2>{-1, 2}));
    EXPECT_EQ(std::get<CurveValue>(spec.default_value), (CurveValue{{{0, 0}, {1, 8}}, {}}));
    EXPECT_FALSE(is_block_type(spec.type));
}

TEST(Curve, IsStraightBetweenPointsAndConstantOutside) {
    const CurveValue curve = curve_of("[[0, 1], [0.5, 3], [2, 0]]");
    EXPECT_EQ(curve.at(-5), 1);
    EXPECT_EQ(curve.at(0), 1);
    EXPECT_EQ(curve.at(0.125), 1.5);
    EXPECT_EQ(curve.at(0.5), 3);
    EXPECT_EQ(curve.at(1.25), 1.5);
    EXPECT_EQ(curve.at(2), 0);
    EXPECT_EQ(curve.at(7), 0);
    EXPECT_EQ(curve_of("[[1, 4]]").at(0), 4);
    EXPECT_EQ(curve_of("[[1, 4]]").at(1.5), 4);
}

TEST(Curve, OfSmoothPointsOnALineIsThatLine) {
    const CurveValue line =
        curve_of(R"({"points": [[-1, 1], [0, 3], [0.25, 3.5], [2, 7]], "interpolation": "smooth"})");
    for (double x = -1; x <= 2; x += 0.0625) EXPECT_NEAR(line.at(x), 3 + 2 * x, 1e-14) << x;
}

TEST(Curve, OfSmoothPointsIsTheCubicWithTheMeanOfTheSecantsAsSlopes) {
    // Secants 1, 3 and 2: slopes 1, 2, 2.5, 2, none of which needs limiting.
    const CurveValue curve =
        curve_of(R"({"points": [[-1, 1], [0, 2], [1, 5], [2, 7]], "interpolation": "smooth"})");
    EXPECT_NEAR(curve.at(0.5), (2 + 5) / 2.0 + (2 - 2.5) / 8, 1e-15);
    EXPECT_NEAR(curve.at(-0.5), (1 + 2) / 2.0 + (1 - 2) / 8.0, 1e-15);
    EXPECT_NEAR(curve.at(1.5), (5 + 7) / 2.0 + (2.5 - 2) / 8, 1e-15);
}

TEST(Curve, OfSmoothPointsLimitsSlopesToTheCircleOfRadiusThree) {
    // Secants 0.1 and 10: the slope 5.05 at 0 is 50.5 secants of the first interval, the end's 1.
    const CurveValue curve =
        curve_of(R"({"points": [[-1, 0], [0, 0.1], [0.9, 9.1]], "interpolation": "smooth"})");
    const double alpha = 1, beta = 50.5, tau = 3 / std::hypot(alpha, beta);
    EXPECT_NEAR(curve.at(-0.5), 0.05 + 0.1 * tau * (alpha - beta) / 8, 1e-14);
}

TEST(Curve, OfSmoothPointsIsMonotoneWhereverThePointsAre) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> gap(0.001, 1), height(0, 1);
    for (int trial = 0; trial < 300; ++trial) {
        CurveValue curve{{{0, 0}}, CurveValue::Interpolation::smooth};
        for (int i = 0; i < 12; ++i) {
            // Flat parts, small steps and cliffs, up and down.
            const double step = std::pow(height(random), 6) * (trial % 2 && height(random) < 0.4 ? -1 : 1);
            const auto& last = curve.points.back();
            curve.points.push_back({last[0] + gap(random), last[1] + (i % 5 == 3 ? 0 : step)});
        }
        for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
            const auto& a = curve.points[i];
            const auto& b = curve.points[i + 1];
            EXPECT_EQ(curve.at(a[0]), a[1]);
            double before = a[1];
            for (int k = 1; k <= 200; ++k) {
                const double y = curve.at(std::lerp(a[0], b[0], k / 200.0));
                const double rise = (y - before) * (b[1] >= a[1] ? 1 : -1);
                ASSERT_GE(rise, -1e-14) << "trial " << trial << ", interval " << i << ", step " << k;
                before = y;
            }
        }
    }
}

TEST(Curve, OfSmoothPointsHasNoKinks) {
    const CurveValue curve =
        curve_of(R"({"points": [[-1, 0], [0, 1], [0.5, 6], [2, 7]], "interpolation": "smooth"})");
    constexpr double kStep = 1e-6;
    for (const double x : {0.0, 0.5}) {
        const double left = (curve.at(x) - curve.at(x - kStep)) / kStep;
        const double right = (curve.at(x + kStep) - curve.at(x)) / kStep;
        EXPECT_NEAR(left, right, 1e-3) << x;
        EXPECT_GT(left, 0.5);
    }
}

TEST(Curve, SaysWhichPointIsWrongAndWhy) {
    const ParamSpec spec = spec_of(kFalloff);
    EXPECT_EQ(value_faults(spec, R"([[0, 0], [0, 1], [3, 1], [1, 11], [1.5, "1 m"], 7, ["0 px", 1]])", "a.p"),
              (Lines{
                  "doc.json:1:10: error: a.p[1]: x 0 must lie above the x of the point before, 0",
                  "doc.json:1:19: error: a.p[2]: x 3 lies outside the domain, -1 to 2",
                  "doc.json:1:30: error: a.p[3]: 11 px is above the maximum 10 px",
                  "doc.json:1:41: error: a.p[4]: '1 m' cannot be converted to px; write 'px'",
                  "doc.json:1:49: error: a.p[5]: expected a point, [x, y]",
                  "doc.json:1:52: error: a.p[6]: expected a point, [x, y]",
              }));
    EXPECT_EQ(value_faults(spec, "[]"), Lines{"doc.json:1:1: error: p: 0 points; a curve has from 1 to 64"});
    std::string many;
    for (int i = 0; i < 65; ++i) many += (i ? ", [" : "[") + std::to_string(i / 64.0) + ", 0]";
    EXPECT_EQ(value_faults(spec, "[" + many + "]"),
              Lines{"doc.json:1:1: error: p: 65 points; a curve has from 1 to 64"});
    EXPECT_EQ(value_faults(spec, "0.5"),
              Lines{"doc.json:1:1: error: p: expected points, [[x, y], ...], or an "
                    "object with 'points' and 'interpolation', not a number"});
    EXPECT_EQ(value_faults(spec, R"({"points": [[0, -1]], "interpolaton": "smooth"})"),
              (Lines{"doc.json:1:23: error: p has no key 'interpolaton'; did you mean 'interpolation'?",
                     "doc.json:1:17: error: p.points[0]: -1 px is below the minimum 0 px"}));
    EXPECT_EQ(value_faults(spec, R"({"interpolation": "cubic"})"),
              (Lines{"doc.json:1:19: error: 'interpolation' is 'cubic' but must be 'linear' or 'smooth'",
                     "doc.json:1:1: error: p has no 'points'"}));
}

TEST(Curve, RefusesWhatOnlyValuesOfABlockHave) {
    EXPECT_EQ(test::spec_faults(R"({"type": "curve", "domain": [1, 0], "default": [[0, 0]], "doc": "."})"),
              Lines{"doc.json:1:29: error: 'domain' holds two numbers that rise, the ends of x"});
    EXPECT_EQ(
        test::spec_faults(R"({"type": "curve", "domain": [1, 0], "bind": "define", "from": "camera.x",
"requires": ["> a"], "default": [[0, 0]], "doc": "."})"),
        (Lines{
            "doc.json:1:45: error: a curve cannot be a define: it reaches a shader as a texture or a "
            "buffer",
            "doc.json:1:55: " + test::only_block_types_have("from"),
            "doc.json:2:1: error: parameter 'p' has no key 'requires'; it is a key of type 'float', 'int' or "
            "'angle'",
        }));
    EXPECT_EQ(test::spec_faults(R"({"type": "float", "domain": [0, 1], "default": 0, "doc": "."})"),
              Lines{"doc.json:1:19: error: parameter 'p' has no key 'domain'; it is a key of type 'curve'"});
}

}  // namespace
}  // namespace aftershade
