#include "framework/document/param.h"

#include "tests/document/param_specs.h"
#include "tests/documents.h"

namespace aftershade {
namespace {

using test::faults_of;
using test::Lines;
using test::parsed;
using test::spec_of;

Lines value_faults(const std::string& declaration, const std::string& value, const std::string& label = "p") {
    const ParamSpec spec = spec_of(declaration);
    return faults_of(value, [&](const Node& node, Diagnostics& diagnostics) {
        EXPECT_FALSE(parse_param_value(spec, node, label, diagnostics).has_value());
    });
}

ParamValue value_of(const std::string& declaration, const std::string& value) {
    Diagnostics diagnostics;
    const auto read = parse_param_value(spec_of(declaration), parsed(value), "p", diagnostics);
    EXPECT_EQ(test::lines_of(diagnostics), Lines{}) << value;
    return read.value_or(ParamValue{});
}

const std::string kFNumber = R"({"type": "float", "default": 2.8, "min": 0.05, "max": 1000, "doc": "."})";
const std::string kFocal =
    R"({"type": "float", "unit": "mm", "default": 50, "min": 1, "max": 5000, "doc": "."})";
const std::string kFocus = R"({"type": "float", "unit": "m", "default": 3, "doc": "."})";
const std::string kTaps = R"({"type": "int", "default": 0, "min": 0, "max": 513, "doc": "."})";
const std::string kShape =
    R"({"type": "enum", "values": ["square", "hexagon", "octagon"], "default": "square", "doc": "."})";
const std::string kTint = R"({"type": "color", "default": [1, 1, 1], "min": 0, "doc": "."})";
const std::string kOffset =
    R"({"type": "vec2", "unit": "mm", "default": [0, 0], "min": -10, "max": 10, "doc": "."})";

TEST(ParamValue, OutsideItsRangeNamesValueLimitAndUnit) {
    EXPECT_EQ(value_faults(kFNumber, "0.02", "bokeh.f_number"),
              Lines{"doc.json:1:1: error: bokeh.f_number: 0.02 is below the minimum 0.05"});
    EXPECT_EQ(value_faults(kFNumber, "\n 1000.5", "bokeh.f_number"),
              Lines{"doc.json:2:2: error: bokeh.f_number: 1000.5 is above the maximum 1000"});
    EXPECT_EQ(value_faults(kFocal, "0.5"), Lines{"doc.json:1:1: error: p: 0.5 mm is below the minimum 1 mm"});
    EXPECT_EQ(value_faults(kFocal, "\"5.5 m\""),
              Lines{"doc.json:1:1: error: p: 5500 mm is above the maximum 5000 mm"});
}

TEST(ParamValue, MayLieOnItsLimits) {
    EXPECT_EQ(value_of(kFNumber, "0.05"), ParamValue(0.05));
    EXPECT_EQ(value_of(kFNumber, "1000"), ParamValue(1000.0));
    EXPECT_EQ(value_of(kFocal, "\"0.1 cm\""), ParamValue(1.0));
}

TEST(ParamValue, IsConvertedToTheDeclaredUnitExactly) {
    EXPECT_EQ(value_of(kFocus, "\"85 mm\""), ParamValue(0.085));
    EXPECT_EQ(value_of(kFocus, "0.085"), ParamValue(0.085));
    EXPECT_EQ(value_of(kFocal, "\"0.085 m\""), ParamValue(85.0));
    const std::string angle = R"({"type": "angle", "default": 0, "doc": "."})";
    EXPECT_EQ(spec_of(angle).unit, "deg");
    EXPECT_EQ(value_of(angle, "\"0.5 turn\""), ParamValue(180.0));
    EXPECT_EQ(value_of(kOffset, "[1, \"-0.2 cm\"]"), ParamValue(std::vector<double>{1, -2}));
}

TEST(ParamValue, OfAnotherKindOrUnitNamesTheRemedy) {
    EXPECT_EQ(value_faults(kFNumber, "true"),
              Lines{"doc.json:1:1: error: p: expected a number, not true or false"});
    EXPECT_EQ(value_faults(kFNumber, "\"f/2\""), Lines{"doc.json:1:1: error: p: 'f/2' is not a number"});
    EXPECT_EQ(value_faults(kFNumber, "\"2 mm\""),
              Lines{"doc.json:1:1: error: p: '2 mm' has a unit, but this is a pure number"});
    EXPECT_EQ(value_faults(kFocus, "[3]"),
              Lines{"doc.json:1:1: error: p: expected a number in m, not an array"});
    EXPECT_EQ(value_faults(kFocus, "\"3\""),
              Lines{"doc.json:1:1: error: p: '3' is not a number in m or a string such as \"1 m\""});
    EXPECT_EQ(
        value_faults(kFocus, "\"30 deg\""),
        Lines{"doc.json:1:1: error: p: '30 deg' cannot be converted to m; write 'um', 'mm', 'cm', 'm', 'km', "
              "'in' or 'ft'"});
}

TEST(ParamValue, OfAnIntIsAWholeNumberInThirtyTwoBits) {
    EXPECT_EQ(value_of(kTaps, "17"), ParamValue(std::int64_t(17)));
    EXPECT_EQ(value_of(kTaps, "17.0"), ParamValue(std::int64_t(17)));
    EXPECT_EQ(value_faults(kTaps, "2.5"), Lines{"doc.json:1:1: error: p: 2.5 is not a whole number"});
    EXPECT_EQ(value_faults(kTaps, "-1"), Lines{"doc.json:1:1: error: p: -1 is below the minimum 0"});
    EXPECT_EQ(value_faults(kTaps, "514"), Lines{"doc.json:1:1: error: p: 514 is above the maximum 513"});
    const std::string wide = R"({"type": "int", "default": 0, "doc": "."})";
    EXPECT_EQ(value_of(wide, "-2147483648"), ParamValue(std::int64_t(-2147483648)));
    EXPECT_EQ(value_faults(wide, "2147483648"),
              Lines{"doc.json:1:1: error: p: 2147483648 does not fit 32 bits"});
    EXPECT_EQ(value_faults(wide, "-2147483649"),
              Lines{"doc.json:1:1: error: p: -2147483649 does not fit 32 bits"});
    EXPECT_EQ(value_faults(wide, "\"many\""), Lines{"doc.json:1:1: error: p: 'many' is not a number"});
}

TEST(ParamValue, OfAnEnumIsOneOfItsNames) {
    EXPECT_EQ(value_of(kShape, "\"octagon\""), ParamValue(std::string("octagon")));
    EXPECT_EQ(
        value_faults(kShape, "\"hexagone\""),
        Lines{
            "doc.json:1:1: error: p: 'hexagone' is not one of 'square', 'hexagon' or 'octagon'; did you mean "
            "'hexagon'?"});
    EXPECT_EQ(
        value_faults(kShape, "1"),
        Lines{"doc.json:1:1: error: p: expected one of 'square', 'hexagon' or 'octagon', not an integer"});
}

TEST(ParamValue, OfAVectorHasItsCountAndEachComponentItsRange) {
    EXPECT_EQ(value_of(kTint, "[0.5, 1, 2]"), ParamValue(std::vector<double>{0.5, 1, 2}));
    EXPECT_EQ(value_faults(kTint, "[1, 1]"), Lines{"doc.json:1:1: error: p: expected an array of 3 numbers"});
    EXPECT_EQ(value_faults(kTint, "1"), Lines{"doc.json:1:1: error: p: expected an array of 3 numbers"});
    EXPECT_EQ(value_faults(kTint, "[1, -0.5, \"red\"]"),
              (Lines{"doc.json:1:5: error: p: -0.5 is below the minimum 0",
                     "doc.json:1:11: error: p: 'red' is not a number"}));
    EXPECT_EQ(value_faults(kOffset, "[\"11 mm\", 0]"),
              Lines{"doc.json:1:2: error: p: 11 mm is above the maximum 10 mm"});
    EXPECT_EQ(component_count(ParamType::vec4), 4);
    EXPECT_EQ(component_count(ParamType::color), 3);
}

TEST(ParamValue, OfABoolIsNoNumber) {
    const std::string flag = R"({"type": "bool", "default": false, "doc": "."})";
    EXPECT_EQ(value_of(flag, "true"), ParamValue(true));
    EXPECT_EQ(value_faults(flag, "1"),
              Lines{"doc.json:1:1: error: p: expected true or false, not an integer"});
}

TEST(ParamValue, IsFormattedAsADocumentWritesIt) {
    EXPECT_EQ(format_value(true), "true");
    EXPECT_EQ(format_value(std::int64_t(-3)), "-3");
    EXPECT_EQ(format_value(0.1), "0.1");
    EXPECT_EQ(format_value(std::string("hexagon")), "\"hexagon\"");
    EXPECT_EQ(format_value(std::vector<double>{1, 0.5, -2}), "[1, 0.5, -2]");
}

TEST(ParamSpec, KeepsAllThatItsDeclarationSays) {
    const ParamSpec spec = spec_of(R"({"type": "float", "unit": "ev", "default": 1, "min": -32, "max": 32,
        "ui": [-5, 5], "identity": 0, "bind": "define", "from": "camera.f_number", "doc": "Stops."})");
    EXPECT_EQ(spec.name, "p");
    EXPECT_EQ(spec.type, ParamType::float_);
    EXPECT_EQ(param_type_name(spec.type), "float");
    EXPECT_EQ(spec.unit, "ev");
    EXPECT_EQ(spec.default_value, ParamValue(1.0));
    EXPECT_EQ(spec.min, -32.0);
    EXPECT_EQ(spec.max, 32.0);
    EXPECT_EQ(spec.ui_range, (std::array<double, 2>{-5, 5}));
    EXPECT_EQ(spec.identity, ParamValue(0.0));
    EXPECT_EQ(spec.bind, ParamBind::define);
    EXPECT_EQ(spec.from, "camera.f_number");
    EXPECT_EQ(spec.doc, "Stops.");
}

struct BrokenSpec {
    std::string declaration;
    Lines faults;
};

const std::vector<BrokenSpec> kBrokenSpecs = {
    {"[]", {"doc.json:1:1: error: parameter 'p' must be an object, not an array"}},
    {"{}",
     {"doc.json:1:1: error: parameter 'p' has no 'type'", "doc.json:1:1: error: parameter 'p' has no 'doc'"}},
    {R"({"type": "flaot", "default": 1, "doc": "."})",
     {"doc.json:1:10: error: 'type' is 'flaot' but must be 'float', 'int', 'bool', 'enum', 'angle', 'color', "
      "'vec2', 'vec3', 'vec4', 'curve', 'file', 'table', 'objects' or 'text'; did you mean 'float'?"}},
    {R"({"type": "float", "unit": "mn", "default": 1, "doc": "."})",
     {"doc.json:1:27: error: 'unit' is 'mn' but must be 'um', 'mm', 'cm', 'm', 'km', 'in', 'ft', 'deg', "
      "'rad', "
      "'turn', 'px', 's', 'ms' or 'ev'; did you mean 'mm'?"}},
    {R"({"type": "bool", "unit": "m", "default": true, "doc": "."})",
     {"doc.json:1:18: " + test::only_numbers_have("unit")}},
    {R"({"type": "bool", "min": 0, "default": true, "ui": [0, 1], "doc": "."})",
     {"doc.json:1:18: " + test::only_numbers_have("min"), "doc.json:1:45: " + test::only_numbers_have("ui")}},
    {R"({"type": "enum", "values": ["a"], "default": "a", "doc": "."})",
     {"doc.json:1:28: error: an enum needs at least two 'values'"}},
    {R"({"type": "enum", "values": ["a", ""], "default": "a", "doc": "."})",
     {"doc.json:1:34: error: '' cannot name a value: a-z, 0-9 and _ only"}},
    {R"({"type": "enum", "values": ["a", "a b", "a"], "default": "a", "doc": "."})",
     {"doc.json:1:34: error: 'a b' cannot name a value: a-z, 0-9 and _ only",
      "doc.json:1:41: error: 'values' holds 'a' twice"}},
    {R"({"type": "int", "values": ["a", "b"], "default": 1, "doc": "."})",
     {"doc.json:1:17: error: parameter 'p' has no key 'values'; it is a key of type 'enum'"}},
    {R"({"type": "float", "default": 1, "min": 3, "max": 2, "doc": "."})",
     {"doc.json:1:1: error: p: 'min' is above 'max'"}},
    {R"({"type": "float", "default": 4, "max": 2, "doc": "."})",
     {"doc.json:1:30: error: p.default: 4 is above the maximum 2"}},
    {R"({"type": "float", "default": 1, "max": 2, "identity": 3, "doc": "."})",
     {"doc.json:1:55: error: p.identity: 3 is above the maximum 2"}},
    {R"({"type": "float", "default": 1, "ui": [0], "doc": "."})",
     {"doc.json:1:39: error: 'ui' holds two numbers, the ends of a slider"}},
    {R"({"type": "float", "default": 1, "min": 0, "ui": [-1, 2], "doc": "."})",
     {"doc.json:1:49: error: 'ui' must rise and stay within 'min' and 'max'"}},
    {R"({"type": "float", "default": 1, "ui": [2, 1], "doc": "."})",
     {"doc.json:1:39: error: 'ui' must rise and stay within 'min' and 'max'"}},
    {R"({"type": "float", "default": 1, "bind": "uniforms", "doc": "."})",
     {"doc.json:1:41: error: 'bind' is 'uniforms' but must be 'uniform' or 'define'; did you mean "
      "'uniform'?"}},
    {R"({"type": "float", "defualt": 1, "doc": "."})",
     {"doc.json:1:1: error: parameter 'p' has no 'default'",
      "doc.json:1:19: error: parameter 'p' has no key 'defualt'; did you mean 'default'?"}},
};

TEST(ParamSpec, SaysWhatIsWrongWithADeclaration) {
    for (const BrokenSpec& broken : kBrokenSpecs) {
        const auto read = [](const Node& node, Diagnostics& diagnostics) {
            test::parse_param_spec("p", node, diagnostics);
        };
        EXPECT_EQ(faults_of(broken.declaration, read), broken.faults) << broken.declaration;
    }
}

TEST(ParamSet, HoldsValuesByName) {
    ParamSet set;
    EXPECT_FALSE(set.has("taps"));
    set.set("taps", std::int64_t(3));
    set.set("taps", std::int64_t(4));
    EXPECT_TRUE(set.has("taps"));
    EXPECT_EQ(set.get("taps"), ParamValue(std::int64_t(4)));
}

}  // namespace
}  // namespace aftershade
