#include "tests/document/param_specs.h"

namespace aftershade {
namespace {

using test::Lines;
using test::spec_of;
using test::value_faults;
using test::value_of;
using Vector = std::vector<double>;

const std::string kLut = R"({"type": "file", "kind": "lut", "default": "", "doc": "."})";

TEST(FileParam, TakesAPathOrNone) {
    const ParamSpec lut = spec_of(kLut);
    EXPECT_EQ(lut.file_kind, FileKind::lut);
    EXPECT_EQ(value_of(lut, "\"grades/warm.cube\""), ParamValue(std::string("grades/warm.cube")));
    EXPECT_EQ(value_faults(lut, "1"),
              Lines{"doc.json:1:1: error: p: expected the path of a file, or \"\" for none, not an integer"});
    const ParamSpec data = spec_of(
        R"({"type": "file", "kind": "image", "space": "data", "default": "a/../mask.png", "doc": "."})");
    EXPECT_EQ(data.file_kind, FileKind::image);
    EXPECT_TRUE(data.file_is_data);
}

TEST(FileParam, OfAManifestStaysInItsFolder) {
    for (const std::string path : {"/etc/passwd", "../a.png", "a/../../b.png", ".."})
        EXPECT_EQ(
            test::spec_faults(R"({"type": "file", "kind": "image", "doc": ".", "default": ")" + path + "\"}"),
            Lines{"doc.json:1:58: error: p.default: '" + path + "' must lie in the effect's folder"});
    spec_of(R"({"type": "file", "kind": "image", "doc": ".", "default": "..mask.png"})");
}

TEST(FileParam, SaysWhatIsWrongWithItsDeclaration) {
    EXPECT_EQ(test::spec_faults(R"({"type": "file", "unit": "m", "min": 0, "space": "srgb", "default": "",
"doc": ".", "kind": "lut"})"),
              (Lines{"doc.json:1:50: error: only a file of kind image has a 'space' or a 'filter'",
                     "doc.json:1:18: " + test::only_numbers_have("unit"),
                     "doc.json:1:31: " + test::only_numbers_have("min")}));
    EXPECT_EQ(test::spec_faults(R"({"type": "file", "default": "", "doc": "."})"),
              Lines{"doc.json:1:1: error: parameter 'p' has no 'kind'"});
    EXPECT_EQ(test::spec_faults(R"({"type": "int", "kind": "lut", "default": 1, "doc": "."})"),
              Lines{"doc.json:1:17: error: parameter 'p' has no key 'kind'; it is a key of type 'file'"});
}

TEST(ParamInterpolation, IsLinearForNumbersOfAContinuousType) {
    const ParamSpec angle = spec_of(R"({"type": "angle", "default": 0, "doc": "."})");
    EXPECT_EQ(interpolate(angle, 350.0, 10.0, 0.25), ParamValue(265.0));
    const ParamSpec gain = spec_of(R"({"type": "float", "default": 0, "doc": "."})");
    EXPECT_EQ(interpolate(gain, 0.1, 0.7, 1), ParamValue(0.7));
    EXPECT_EQ(interpolate(gain, 0.1, 0.7, 0), ParamValue(0.1));
    const ParamSpec tint = spec_of(R"({"type": "color", "default": [0, 0, 0], "doc": "."})");
    EXPECT_EQ(interpolate(tint, Vector{0, 1, 2}, Vector{1, 1, -2}, 0.5), ParamValue(Vector{0.5, 1, 0}));
}

TEST(ParamInterpolation, HoldsEverythingElseUntilTheNextKey) {
    const ParamSpec taps = spec_of(R"({"type": "int", "default": 0, "doc": "."})");
    const ParamValue one = std::int64_t(1), nine = std::int64_t(9);
    EXPECT_EQ(interpolate(taps, one, nine, 0.999), one);
    EXPECT_EQ(interpolate(taps, one, nine, 1), nine);
    const ParamSpec curve = spec_of(R"({"type": "curve", "default": [[0, 0]], "doc": "."})");
    const ParamValue a = CurveValue{{{0, 0}}, {}}, b = CurveValue{{{0, 1}}, {}};
    EXPECT_EQ(interpolate(curve, a, b, 0.5), a);
    EXPECT_EQ(interpolate(curve, a, b, 1), b);
    EXPECT_EQ(interpolate(spec_of(kLut), std::string("a"), std::string("b"), 0.5),
              ParamValue(std::string("a")));
}

TEST(PixelScale, MultipliesWhatIsInPixels) {
    const ParamSpec radius =
        spec_of(R"({"type": "float", "unit": "px", "default": 64, "min": 1, "doc": "."})");
    EXPECT_EQ(scale_pixels(radius, 64.0, 0.25), ParamValue(16.0));
    const ParamSpec offset = spec_of(R"({"type": "vec2", "unit": "px", "default": [0, 0], "doc": "."})");
    EXPECT_EQ(scale_pixels(offset, Vector{-4, 3}, 0.5), ParamValue(Vector{-2, 1.5}));
    const ParamSpec tile = spec_of(R"({"type": "int", "unit": "px", "default": 20, "min": 2, "doc": "."})");
    EXPECT_EQ(scale_pixels(tile, std::int64_t(19), 0.25), ParamValue(std::int64_t(5)));
    EXPECT_EQ(scale_pixels(tile, std::int64_t(20), 0.01), ParamValue(std::int64_t(2)));
    const ParamSpec curve = spec_of(R"({"type": "curve", "unit": "px", "default": [[0, 0]], "doc": "."})");
    EXPECT_EQ(scale_pixels(curve, CurveValue{{{0, 2}, {1, 4}}, {}}, 0.5),
              ParamValue(CurveValue{{{0, 1}, {1, 2}}, {}}));
    const ParamSpec table = spec_of(R"({"type": "table", "columns": {
        "r": {"type": "float", "unit": "px", "default": 8, "doc": "."},
        "g": {"type": "float", "default": 8, "doc": "."}}, "doc": "."})");
    EXPECT_EQ(scale_pixels(table, value_of(table, R"({"rows": [{"object": 1, "r": 4}]})"), 0.5),
              ParamValue(TableValue{{{4}, {8}}, {{{1, 1, ""}, {{2}, {8}}}}}));
}

TEST(PixelScale, LeavesEverythingElse) {
    const ParamSpec focal = spec_of(R"({"type": "float", "unit": "mm", "default": 50, "doc": "."})");
    EXPECT_EQ(scale_pixels(focal, 50.0, 0.5), ParamValue(50.0));
    const ParamSpec flag = spec_of(R"({"type": "bool", "default": true, "doc": "."})");
    EXPECT_EQ(scale_pixels(flag, true, 0.5), ParamValue(true));
    EXPECT_EQ(scale_pixels(spec_of(kLut), std::string("a"), 0.5), ParamValue(std::string("a")));
}

TEST(ParamValue, OfACurveOrAFileIsFormattedAsADocumentWritesIt) {
    EXPECT_EQ(format_value(std::string("a \"b\"\\c")), R"("a \"b\"\\c")");
    EXPECT_EQ(format_value(CurveValue{{{0, 0.5}, {1, -2}}, {}}), "[[0, 0.5], [1, -2]]");
    EXPECT_EQ(format_value(CurveValue{{{0, 1}}, CurveValue::Interpolation::smooth}),
              R"({"points": [[0, 1]], "interpolation": "smooth"})");
}

TEST(ParamValue, IsNumbersToATableAndABlock) {
    EXPECT_EQ(numbers_of(spec_of(R"({"type": "enum", "values": ["a", "b"], "default": "a", "doc": "."})"),
                         std::string("b")),
              Vector{1});
    EXPECT_EQ(numbers_of(spec_of(R"({"type": "bool", "default": true, "doc": "."})"), true), Vector{1});
    EXPECT_EQ(numbers_of(spec_of(R"({"type": "vec2", "default": [1, 2], "doc": "."})"), Vector{3, 4}),
              (Vector{3, 4}));
}

}  // namespace
}  // namespace aftershade
