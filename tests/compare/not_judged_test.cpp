// A verdict names what no limit holds.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "framework/compare/comparison_report.h"
#include "tests/compare/pictures.h"

namespace aftershade {
namespace {

using test::constant;
using test::kInfinity;
using Texts = std::vector<std::string>;

/// Two files of equal colours: coverage, depth, normals, velocity and ids differ wholly.
class NotJudged : public testing::Test {
protected:
    NotJudged() {
        const auto write = [&](const char* name, float sign) {
            Image ids(8, 8, 1, ComponentType::uint32);
            std::ranges::fill(ids.uints(), sign > 0 ? 1u : 2u);
            test::write_exr_file(folder_ / name,
                                 {{{"R", "G", "B"}, constant(8, 8, {0.5f, 0.2f, 0.1f})},
                                  {{"A"}, constant(8, 8, {sign > 0 ? 1.0f : 0.0f})},
                                  {{"Z"}, constant(8, 8, {3 + sign})},
                                  {{"normal.X", "normal.Y", "normal.Z"}, constant(8, 8, {0, 0, sign})},
                                  {{"velocity.X", "velocity.Y"}, constant(8, 8, {25 * sign, 0})},
                                  {{"object_id.I"}, std::move(ids)}});
        };
        write("r.exr", 1);
        write("t.exr", -1);
    }
    Comparison compared(const CompareRules& rules) {
        return compare_files(folder_ / "r.exr", folder_ / "t.exr", rules);
    }
    /// FLIP alone.
    static CompareRules by_flip(double limit = kInfinity) {
        CompareRules rules;
        rules.fail.limit = limit;
        rules.fail_flip = 0.01;
        return rules;
    }
    test::TemporaryFolder folder_;
};

TEST_F(NotJudged, AreLayersThatOnlyFlipWouldHaveHeld) {
    for (const double limit : std::vector<double>{kInfinity, 1e30, 1e6}) {
        const CompareRules rules = by_flip(limit);
        const Comparison comparison = compared(rules);
        Texts names = comparison.not_judged();
        std::ranges::sort(names);
        const Texts expected = {"A", "Z", "normal.XYZ", "velocity.XY"};
        EXPECT_EQ(names, expected) << limit << ": ids that differ fail above any limit";
    }
    CompareRules rules = by_flip();
    rules.roles["object_id.I"] = LayerRole::data;
    const Comparison comparison = compared(rules);
    EXPECT_EQ(comparison.verdict, Verdict::same);
    EXPECT_NE(text_of(comparison, rules).find("\nsame (not judged: "), std::string::npos);
    const nlohmann::ordered_json json = json_of(comparison, rules);
    EXPECT_EQ(json["not_judged"].size(), 5u);
    for (const auto& layer : json["layers"]) EXPECT_EQ(layer["not_judged"].empty(), layer["layer"] == "RGB");
}

TEST_F(NotJudged, AreNoneWhereAnyLevelLimits) {
    const auto none = [&](const CompareRules& rules) { return compared(rules).not_judged().empty(); };
    EXPECT_TRUE(none({}));
    CompareRules rules = by_flip();
    rules.fail.hard = 0.5;
    EXPECT_TRUE(none(rules)) << "hard";
    rules = by_flip();
    rules.warn = Tolerance{.limit = 0.5};
    EXPECT_TRUE(none(rules)) << "warn";
    rules.warn.reset();
    rules.fail.limit = 0.5;
    EXPECT_TRUE(none(rules));
    rules.fail.percent = 100;
    EXPECT_TRUE(none(rules)) << "what only the percentage lets pass is a warning";
    rules.warn = rules.fail;
    EXPECT_FALSE(none(rules)) << "every pixel may";
    rules.warn.reset();
    rules.fail.percent = 0, rules.fail.allowed = 64;
    EXPECT_FALSE(none(rules)) << "every pixel may";
}

TEST_F(NotJudged, IsCoverageWithALimitOfOneAndAnythingByATwofoldRelativeOne) {
    CompareRules rules;
    rules.fail.limit = 1;
    EXPECT_EQ(compared(rules).not_judged(), Texts{"A"});
    rules.fail.limit = 0.1, rules.fail.relative = 2;
    Texts names = compared(rules).not_judged();
    std::ranges::sort(names);
    EXPECT_EQ(names, (Texts{"A", "RGB", "normal.XYZ", "velocity.XY"})) << "depth is relative by itself";
}

TEST_F(NotJudged, AreLayersOfTheRoleIgnore) {
    CompareRules rules;
    for (const char* label : {"A", "Z", "normal.XYZ", "velocity.XY", "object_id.I"})
        rules.roles[label] = std::nullopt;
    const Comparison comparison = compared(rules);
    EXPECT_EQ(comparison.verdict, Verdict::same);
    EXPECT_EQ(comparison.not_judged().size(), 5u);
}

TEST_F(NotJudged, IsNamedByItsAreaWhereOnlyThatHasNoLimit) {
    CompareRules rules;
    rules.fail.limit = 0.5;
    Levels none;
    none.fail.limit = kInfinity;
    rules.areas = {{"0,0,2,2", rectangle_area(0, 0, 2, 2), none}};
    const Texts names = compared(rules).not_judged();
    EXPECT_NE(std::ranges::find(names, "Z in the area 0,0,2,2"), names.end());
    rules.fail.limit = kInfinity;
    rules.areas[0].levels->fail.limit = 0.5;
    const Texts rest = compared(rules).not_judged();
    EXPECT_NE(std::ranges::find(rest, "Z outside of the areas"), rest.end());
}

}  // namespace
}  // namespace aftershade
