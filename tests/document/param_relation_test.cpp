#include "tests/document/param_specs.h"

namespace aftershade {
namespace {

using test::Lines;
using test::spec_faults;
using test::spec_of;

std::string number(const std::string& unit, const std::string& value, const std::string& requires_list) {
    return R"({"type": "float", "unit": ")" + unit + R"(", "default": )" + value + R"(, "requires": )" +
           requires_list + R"(, "doc": "."})";
}

std::vector<ParamSpec> lens(const std::string& relation) {
    return {spec_of(number("m", "3", "[\"" + relation + "\"]"), "focus_distance"),
            spec_of(number("mm", "50", "[]"), "focal_length")};
}

/// The messages of `relation` for a focus distance in m and a focal length in mm.
Lines broken(const std::string& relation, double focus_m, double focal_mm) {
    const auto specs = lens(relation);
    ParamSet values;
    values.set("focus_distance", focus_m);
    values.set("focal_length", focal_mm);
    Lines lines;
    for (const RelationFault& fault : check_relations(specs, values))
        lines.push_back(relation_message("bokeh", fault));
    return lines;
}

TEST(ParamRelation, ComparesValuesInOneUnit) {
    EXPECT_EQ(broken("> focal_length", 0.04, 50),
              Lines{"bokeh.focus_distance: 0.04 m must be above focal_length, 50 mm"});
    EXPECT_EQ(broken("> focal_length", 0.051, 50), Lines{});
    EXPECT_EQ(broken("< focal_length", 1, 50),
              Lines{"bokeh.focus_distance: 1 m must be below focal_length, 50 mm"});
    EXPECT_EQ(broken("<=focal_length", 1, 50),
              Lines{"bokeh.focus_distance: 1 m must be at most focal_length, 50 mm"});
    EXPECT_EQ(broken(" >=  focal_length ", 0.01, 50),
              Lines{"bokeh.focus_distance: 0.01 m must be at least focal_length, 50 mm"});
}

TEST(ParamRelation, TakesOneLengthInTwoUnitsForEqual) {
    // Every whole number of millimetres, though some are no exact binary number of metres.
    for (int mm = 1; mm <= 5000; ++mm) {
        ASSERT_EQ(broken(">= focal_length", mm / 1000.0, mm), Lines{}) << mm;
        ASSERT_EQ(broken("<= focal_length", mm / 1000.0, mm), Lines{}) << mm;
        ASSERT_EQ(broken("> focal_length", mm / 1000.0, mm).size(), 1u) << mm;
    }
}

TEST(ParamRelation, ComparesIntsAndFloats) {
    std::vector<ParamSpec> specs = {
        spec_of(R"({"type": "int", "default": 8, "requires": ["<= limit"], "doc": "."})", "taps"),
        spec_of(R"({"type": "float", "default": 8.5, "doc": "."})", "limit")};
    ParamSet values;
    values.set("taps", std::int64_t(9));
    values.set("limit", 8.5);
    const auto faults = check_relations(specs, values);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].spec, &specs[0]);
    EXPECT_EQ(faults[0].other, &specs[1]);
    EXPECT_EQ(faults[0].value, 9);
    EXPECT_EQ(faults[0].other_value, 8.5);
    EXPECT_EQ(relation_message("s", faults[0]), "s.taps: 9 must be at most limit, 8.5");
}

TEST(ParamRelation, IsReadWithItsPlace) {
    const ParamSpec spec = spec_of(number("m", "3", R"(["> focal_length", "<= far"])"));
    ASSERT_EQ(spec.relations.size(), 2u);
    EXPECT_EQ(spec.relations[1].order, ParamRelation::Order::less_equal);
    EXPECT_EQ(spec.relations[1].other, "far");
    EXPECT_EQ(to_string(spec.relations[1].place), "doc.json:1:77");
    const std::string remedy =
        "; write '<', '<=', '>' or '>=' and the name of a parameter: \"> focal_length\"";
    EXPECT_EQ(spec_faults(number("m", "3", R"(["focal_length", "= far", 2])")),
              (Lines{"doc.json:1:59: error: 'focal_length' is not a relation" + remedy,
                     "doc.json:1:75: error: '= far' is not a relation" + remedy,
                     "doc.json:1:84: error: 'requires' holds strings, not an integer"}));
    EXPECT_EQ(spec_faults(R"({"type": "vec2", "default": [0, 0], "requires": ["> a"], "doc": "."})"),
              Lines{"doc.json:1:37: error: parameter 'p' has no key 'requires'; it is a key of type 'float', "
                    "'int' or "
                    "'angle'"});
}

Lines declaration_faults(const std::vector<ParamSpec>& specs) {
    Diagnostics diagnostics;
    check_relation_declarations(specs, diagnostics);
    return test::lines_of(diagnostics);
}

TEST(ParamRelation, OfAManifestNamesScalarsThatCanBeCompared) {
    const std::string where = "doc.json:1:59: error: ";
    EXPECT_EQ(declaration_faults(lens("> focal_length")), Lines{});
    EXPECT_EQ(declaration_faults(lens("> focal_lenght")),
              Lines{where + "parameter 'focus_distance': 'focal_lenght' is not a parameter; did you mean "
                            "'focal_length'?"});
    EXPECT_EQ(declaration_faults(lens("> focus_distance")),
              Lines{where + "parameter 'focus_distance': a parameter has no relation to itself"});
    EXPECT_EQ(declaration_faults(lens("< focal_length")),
              Lines{where + "focus_distance.default: 3 m must be below focal_length, 50 mm"});
    std::vector<ParamSpec> specs = lens("> other");
    specs.push_back(spec_of(R"({"type": "angle", "default": 0, "doc": "."})", "other"));
    EXPECT_EQ(declaration_faults(specs), Lines{where + "parameter 'focus_distance': 'other' is in deg, which "
                                                       "cannot be compared with m"});
    specs.back() = spec_of(R"({"type": "int", "default": 0, "doc": "."})", "other");
    EXPECT_EQ(declaration_faults(specs),
              Lines{where + "parameter 'focus_distance': 'other' is a pure number, "
                            "which cannot be compared with m"});
    specs.back() = spec_of(R"({"type": "color", "default": [0, 0, 0], "doc": "."})", "other");
    EXPECT_EQ(declaration_faults(specs),
              Lines{where + "parameter 'focus_distance': 'other' is of type color, which has no order"});
}

}  // namespace
}  // namespace aftershade
