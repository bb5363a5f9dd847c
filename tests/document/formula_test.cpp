#include "framework/document/formula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace aftershade {
namespace {

std::optional<double> value_of(std::string_view name) {
    if (name == "width" || name == "$WIDTH") return 1920;
    if (name == "half") return 0.5;
    return std::nullopt;
}

TEST(Formula, ComputesAsArithmeticIsWritten) {
    const std::vector<std::pair<const char*, double>> values = {
        {"2 + 3 * 4", 14},
        {"(2 + 3) * 4", 20},
        {"8 / 4 / 2", 1},
        {"8 - 4 - 2", 2},
        {"-2 * -3", 6},
        {"- - 2", 2},
        {"floor($WIDTH/7.0)", 274},
        {"max(floor(width * 0.02), 1.0)", 38},
        {"min(1, half)", 0.5},
        {"ceil(1.2) + round(2.5) + trunc(-1.7) + abs(-3)", 7},
        {"mod(-1, 4)", 3},
        {"pow(2, 10) + sqrt(81)", 1033},
        {".5 + 1.", 1.5},
        {"1e3", 1000}};
    for (const auto& [text, expected] : values) {
        const FormulaResult result = evaluate_formula(text, value_of);
        EXPECT_EQ(result.fault, "") << text;
        EXPECT_EQ(result.value, expected) << text;
    }
    EXPECT_TRUE(std::isinf(evaluate_formula("1 / 0", value_of).value));
}

TEST(Formula, SaysWhatIsWrongAndWhere) {
    const std::string deep(100, '('), minus(100, '-'), longer(kMaxFormulaBytes + 1, '1');
    const std::vector<std::tuple<std::string, std::size_t, const char*>> faults = {
        {"", 0, "ends where"},
        {"2 +", 3, "ends where"},
        {"(2 + 3", 6, "a ')' is missing"},
        {"2 3", 2, "'3' is not expected here"},
        {"2 * height", 4, "'height' is not a number"},
        {"sin(2)", 0, "'sin' is not a function"},
        {"max(1)", 5, "'max' takes 2 numbers"},
        {"1e999", 0, "not a number"},
        {"#", 0, "'#' is not expected here"},
        {deep, 32, "the limit"},
        {minus, 32, "the limit"},
        {longer, 0, "the limit"}};
    for (const auto& [text, at, message] : faults) {
        const FormulaResult result = evaluate_formula(text, value_of);
        EXPECT_EQ(result.at, at) << text;
        EXPECT_NE(result.fault.find(message), std::string::npos) << text << ": " << result.fault;
    }
}

}  // namespace
}  // namespace aftershade
