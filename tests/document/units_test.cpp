#include "framework/document/units.h"

#include <clocale>
#include <limits>
#include <locale>
#include <numbers>

#include "framework/document/param.h"
#include "tests/documents.h"

namespace aftershade {
namespace {

/// "85 mm" in `unit`; NaN where it does not convert.
double in_unit(const std::string& text, const std::string& unit) {
    const auto quantity = parse_quantity(text);
    const auto value = quantity ? convert_unit(quantity->value, quantity->unit, unit) : std::nullopt;
    return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

// EXPECT_EQ on doubles: equal in every bit to what the compiler makes of the literal.
TEST(Units, ConvertToTheDoubleThatOneWouldWrite) {
    EXPECT_EQ(in_unit("85 mm", "m"), 0.085);
    EXPECT_EQ(in_unit("0.085 m", "mm"), 85.0);
    EXPECT_EQ(in_unit("36 mm", "cm"), 3.6);
    EXPECT_EQ(in_unit("3.6 cm", "mm"), 36.0);
    EXPECT_EQ(in_unit("7 um", "mm"), 0.007);
    EXPECT_EQ(in_unit("7 um", "km"), 7e-9);
    EXPECT_EQ(in_unit("1.5 km", "m"), 1500.0);
    EXPECT_EQ(in_unit("1 in", "mm"), 25.4);
    EXPECT_EQ(in_unit("1 ft", "m"), 0.3048);
    EXPECT_EQ(in_unit("1 ft", "in"), 12.0);
    EXPECT_EQ(in_unit("41 ms", "s"), 0.041);
    EXPECT_EQ(in_unit("180 deg", "rad"), std::numbers::pi);
    EXPECT_EQ(in_unit("0.25 turn", "deg"), 90.0);
    EXPECT_EQ(in_unit("1 turn", "rad"), 2 * std::numbers::pi);
    for (int mm = 1; mm <= 1000; ++mm)
        EXPECT_EQ(in_unit(std::to_string(mm) + " mm", "m"), double(mm) / 1000.0);
}

TEST(Units, KeepAValueThatIsInTheUnitAlready) {
    for (const std::string& unit : unit_names()) EXPECT_EQ(convert_unit(0.1, unit, unit), 0.1) << unit;
}

TEST(Units, DoNotConvertBetweenDimensions) {
    EXPECT_EQ(convert_unit(1, "mm", "deg"), std::nullopt);
    EXPECT_EQ(convert_unit(1, "px", "mm"), std::nullopt);
    EXPECT_EQ(convert_unit(1, "s", "ev"), std::nullopt);
    EXPECT_EQ(convert_unit(1, "parsec", "m"), std::nullopt);
    EXPECT_EQ(convert_unit(1, "m", ""), std::nullopt);
    EXPECT_EQ(compatible_units("m"), (std::vector<std::string>{"um", "mm", "cm", "m", "km", "in", "ft"}));
    EXPECT_EQ(compatible_units("deg"), (std::vector<std::string>{"deg", "rad", "turn"}));
    EXPECT_EQ(compatible_units("parsec"), std::vector<std::string>{});
}

TEST(Quantity, IsANumberFollowedByAUnit) {
    struct Good {
        std::string text;
        double value;
        std::string unit;
    };
    const std::vector<Good> good = {{"85 mm", 85, "mm"}, {"85mm", 85, "mm"}, {"-1.5e3 px", -1500, "px"},
                                    {"+2 m", 2, "m"},    {".5 m", 0.5, "m"}, {"1ev", 1, "ev"},
                                    {"1e3m", 1000, "m"}, {"5  in", 5, "in"}, {"0 deg", 0, "deg"}};
    for (const Good& expected : good) {
        const auto quantity = parse_quantity(expected.text);
        ASSERT_TRUE(quantity.has_value()) << expected.text;
        EXPECT_EQ(quantity->value, expected.value) << expected.text;
        EXPECT_EQ(quantity->unit, expected.unit) << expected.text;
    }
    for (const char* bad : {"", "mm", "85", "85 ", "85 MM", "85 parsec", "1,5 mm", "inf m", "nan m",
                            "1e999 m", "0x10 mm", "+-5 mm", "++5 mm", "- 5 mm", "5 mm mm", "five mm"})
        EXPECT_FALSE(parse_quantity(bad).has_value()) << bad;
}

TEST(Number, IsTheWholeText) {
    EXPECT_EQ(parse_number("-2.5e-3"), -0.0025);
    EXPECT_EQ(parse_number("+7"), 7.0);
    for (const char* bad :
         {"", " 1", "1 ", "1,5", "inf", "-inf", "nan", "1e999", "+-5", "0x10", "1.5.2", "1 mm"})
        EXPECT_FALSE(parse_number(bad).has_value()) << bad;
}

TEST(Number, IsWrittenAsTheShortestTextThatReadsBack) {
    EXPECT_EQ(format_number(0.1), "0.1");
    EXPECT_EQ(format_number(0.05), "0.05");
    EXPECT_EQ(format_number(3), "3");
    EXPECT_EQ(format_number(-0.5), "-0.5");
    for (const double value : {1.0 / 3.0, 1e300, 5e-324, 0.1 + 0.2, 123456789.123})
        EXPECT_EQ(parse_number(format_number(value)), value == 5e-324 ? parse_number("5e-324") : value);
}

/// Reads and writes numbers in all ways that documents do.
void expect_points_and_no_commas() {
    EXPECT_EQ(in_unit("1.5 mm", "mm"), 1.5);
    EXPECT_EQ(parse_number("2.25"), 2.25);
    EXPECT_EQ(parse_number("2,25"), std::nullopt);
    EXPECT_EQ(format_number(1234.5), "1234.5");
    EXPECT_EQ(test::parsed("[1.5]").items.at(0).number, 1.5);
    ParamSpec spec;
    spec.min = 1234.5;
    const auto read = [&](const Node& node, Diagnostics& diagnostics) {
        parse_param_value(spec, node, "x", diagnostics);
    };
    EXPECT_EQ(test::faults_of("\n1000.25", read),
              test::Lines{"doc.json:2:1: error: x: 1000.25 is below the minimum 1234.5"});
}

struct GermanPunctuation : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(Locale, OfStreamsChangesNoNumber) {
    const std::locale before = std::locale::global(std::locale(std::locale(), new GermanPunctuation));
    expect_points_and_no_commas();
    std::locale::global(before);
}

TEST(Locale, OfCChangesNoNumber) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    const char* chosen = nullptr;
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR", "de_AT.UTF-8", "nl_NL.UTF-8"})
        if (!chosen) chosen = std::setlocale(LC_ALL, name);
    if (!chosen) GTEST_SKIP() << "SKIPPED: no locale with a decimal comma is installed";
    EXPECT_STREQ(std::localeconv()->decimal_point, ",");
    expect_points_and_no_commas();
    std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace aftershade
