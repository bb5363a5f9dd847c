#include "framework/golden/golden_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace aftershade::test {
namespace {

std::string faults_of(const Diagnostics& diagnostics) {
    std::ostringstream text;
    diagnostics.print(text);
    return text.str();
}

CompareRules tolerance(const std::string& text, Diagnostics& diagnostics) {
    return parse_golden_tolerance(*parse_document(text, "t.json", diagnostics), diagnostics);
}

std::optional<GoldenCase> effect_case(const std::string& text, Diagnostics& diagnostics) {
    const auto node = parse_document(text, "effects/blur/cases/soft.json", diagnostics);
    return parse_effect_case(*node, "effects/blur/cases/soft.json", "/root", diagnostics);
}

TEST(GoldenCase, OfAnEffectTellsEveryFaultOfItsDocument) {
    Diagnostics diagnostics;
    EXPECT_FALSE(effect_case(
        R"({"aftershade": 1, "capture": "nowhere.json", "frames": "a-b", "steps": [ {"efect": "x"} ],
        "outputs": ["colour"], "tolerance": {"fail": 0.1, "fail_percent": 101, "hard_fail": 0.01}, "tgas": []})",
        diagnostics));
    const std::string faults = faults_of(diagnostics);
    for (const char* part :
         {"soft.json:1:", "'a-b' is not a range", "'efect'; did you mean 'effect'", "fail_percent",
          "'colour' is not a role; did you mean 'color'", "'hard_fail' must be at least", "tgas"})
        EXPECT_NE(faults.find(part), std::string::npos) << part << " in\n" << faults;
    EXPECT_EQ(faults.find("nowhere"), std::string::npos) << "a capture that is absent is skipped";
}

TEST(GoldenCase, OfAnEffectIsNamedByItsFolderAndKeepsItsImagesBesideIt) {
    Diagnostics diagnostics;
    const auto test = effect_case(
        R"({"aftershade": 1, "capture": "scenes/a.json", "frames": "3-4", "steps": [ {"effect": "blur"} ],
        "taps": ["blur.wide"], "outputs": ["color", "aov:hair"], "tolerance": {}, "tags": ["hdr"]})",
        diagnostics);
    ASSERT_TRUE(test) << faults_of(diagnostics);
    EXPECT_EQ(test->name, "blur/soft");
    EXPECT_EQ(test->capture, "/root/scenes/a.json");
    EXPECT_EQ(test->image_stems(),
              (std::vector<std::string>{"soft.color", "soft.aov-hair", "soft.blur.wide"}));
    EXPECT_EQ(golden_image_name("soft.color", 3), "soft.color.0003");
    EXPECT_EQ(test->goldens, "effects/blur/cases");
}

TEST(GoldenCase, OfAnEffectHasANameThatIsNoGlobCommandOrMarkup) {
    const std::string text = R"({"aftershade": 1, "capture": "a.exr", "frames": "1", "steps": [],
        "outputs": ["color"], "tolerance": {}})";
    for (const char* file :
         {"effects/blur/cases/*.json", "effects/blur/cases/-x.json", "effects/<b>/cases/x.json",
          "effects/blur/cases/a b.json", "effects/blur/cases/a\nb.json"}) {
        Diagnostics diagnostics;
        EXPECT_FALSE(parse_effect_case(*parse_document(text, file, diagnostics), file, "/root", diagnostics));
        EXPECT_NE(faults_of(diagnostics).find("has other characters than letters, digits, '_' and '-'"),
                  std::string::npos)
            << faults_of(diagnostics);
    }
}

TEST(GoldenCase, GivesTheStepsOnAsTheyStand) {
    Diagnostics diagnostics;
    const std::string text = R"([{"effect": "a\"b\n", "x": [1, -0.25, true, null], "y": {}}])";
    EXPECT_EQ(json_of_node(*parse_document(text, "steps", diagnostics)), text);
}

TEST(GoldenTolerance, IsExactWithoutAKeyAndWarnsOnlyWhenAsked) {
    Diagnostics diagnostics;
    const CompareRules none = tolerance("{}", diagnostics);
    EXPECT_EQ(none.fail.limit, 1e-6);
    EXPECT_EQ(none.fail.percent, 0);
    EXPECT_TRUE(std::isinf(none.fail.hard));
    const CompareRules fails =
        tolerance(R"({"fail": 0.1, "fail_percent": 2, "hard_fail": 0.5})", diagnostics);
    ASSERT_TRUE(fails.warn);
    EXPECT_EQ(fails.warn->percent, 2) << "what fail_percent lets pass is no warning";
    const CompareRules warns = tolerance(R"({"fail": 0.1, "fail_percent": 2, "warn": 0.01})", diagnostics);
    EXPECT_EQ(warns.warn->limit, 0.01);
    EXPECT_EQ(warns.warn->percent, 0);
    EXPECT_FALSE(diagnostics.has_errors()) << faults_of(diagnostics);
}

TEST(GoldenTolerance, HasEveryKeyOfCompare) {
    Diagnostics diagnostics;
    const CompareRules rules = tolerance(
        R"({"fail": 0.1, "fail_relative": 0.001, "fail_ulp": 2, "fail_percent": 2, "hard_fail": 0.5, "allow_failures": 3, "fail_flip": 0.2, "fail_ssim": 0.9,
            "warn": 0.05, "warn_percent": 1, "hard_warn": 0.4, "allow_warnings": 4, "warn_flip": 0.1,
            "warn_ssim": 0.95, "nan_equal": true})",
        diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << faults_of(diagnostics);
    EXPECT_EQ(rules.fail.relative, 0.001);
    EXPECT_EQ(rules.fail.ulp, 2);
    EXPECT_EQ(rules.fail.limit, 0.1);
    EXPECT_EQ(rules.fail.percent, 2);
    EXPECT_EQ(rules.fail.hard, 0.5);
    EXPECT_EQ(rules.fail.allowed, 3u);
    EXPECT_EQ(rules.warn->limit, 0.05);
    EXPECT_EQ(rules.warn->percent, 1);
    EXPECT_EQ(rules.warn->hard, 0.4);
    EXPECT_EQ(rules.warn->allowed, 4u);
    EXPECT_EQ(rules.fail_flip, 0.2);
    EXPECT_EQ(rules.fail_ssim, 0.9);
    EXPECT_EQ(rules.warn_flip, 0.1);
    EXPECT_EQ(rules.warn_ssim, 0.95);
    EXPECT_TRUE(rules.nan_equal);
}

TEST(GoldenTolerance, RefusesWhatIsOutOfRange) {
    for (const char* text :
         {R"({"fail": -1})", R"({"fail_percent": 101})", R"({"fail": 1, "hard_fail": 0.5})",
          R"({"fail_flip": 1.5})", R"({"allow_failures": -1})", R"({"warn": 1, "hard_warn": 0})",
          R"({"fial": 1})", R"({"fail": "1"})"}) {
        Diagnostics diagnostics;
        tolerance(text, diagnostics);
        EXPECT_EQ(diagnostics.error_count(), 1) << text << "\n" << faults_of(diagnostics);
    }
}

}  // namespace
}  // namespace aftershade::test
