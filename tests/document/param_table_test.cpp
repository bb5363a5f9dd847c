#include "tests/document/param_specs.h"

namespace aftershade {
namespace {

using test::Lines;
using test::spec_faults;
using test::spec_of;
using test::value_faults;
using test::value_of;

const std::string kScales = R"({"type": "table", "columns": {
    "scale": {"type": "float", "unit": "px", "default": 1, "min": 0, "max": 9, "doc": "."},
    "tint": {"type": "color", "default": [1, 0.5, 0.25], "doc": "."},
    "mode": {"type": "enum", "values": ["soft", "hard"], "default": "hard", "doc": "."},
    "on": {"type": "bool", "default": true, "doc": "."}}, "doc": "."})";

TableValue table_of(const std::string& text) {
    return std::get<TableValue>(value_of(spec_of(kScales), text));
}

const TableValue::Row kDefaults = {{1}, {1, 0.5, 0.25}, {1}, {1}};

TEST(Table, HasItsColumnsDefaultsWhereNothingElseIsSaid) {
    const ParamSpec spec = spec_of(kScales);
    ASSERT_EQ(spec.columns.size(), 4u);
    EXPECT_EQ(spec.columns[0].name, "scale");
    EXPECT_EQ(spec.columns[3].type, ParamType::bool_);
    EXPECT_EQ(std::get<TableValue>(spec.default_value), (TableValue{kDefaults, {}}));
    EXPECT_EQ(table_of("{}"), (TableValue{kDefaults, {}}));
}

TEST(Table, FillsRowsFromItsDefaultRow) {
    const TableValue table = table_of(R"({"default": {"scale": 2, "on": false}, "rows": [
        {"object": 4294967295, "scale": "3 px"},
        {"objects": " 3-7, 9", "mode": "soft"},
        {"name": "Wheel", "tint": [0, 0, 1], "on": true}]})");
    const std::vector<std::pair<TableKey, TableValue::Row>> rows = {
        {{4294967295u, 4294967295u, ""}, {{3}, {1, 0.5, 0.25}, {1}, {0}}},
        {{3, 7, ""}, {{2}, {1, 0.5, 0.25}, {0}, {0}}},
        {{9, 9, ""}, {{2}, {1, 0.5, 0.25}, {0}, {0}}},
        {{0, 0, "Wheel"}, {{2}, {0, 0, 1}, {1}, {1}}},
    };
    EXPECT_EQ(table.default_row, (TableValue::Row{{2}, {1, 0.5, 0.25}, {1}, {0}}));
    EXPECT_EQ(table.rows, rows);
}

TEST(Table, SaysWhatIsWrongWithEachCell) {
    const ParamSpec spec = spec_of(kScales);
    EXPECT_EQ(
        value_faults(spec, R"({"default": {"scael": 1}, "rows": [
{"object": 1, "scale": 10}, {"object": 2, "mode": "softer"},
{"name": "a", "scale": "1 mm", "size": 1}, 4], "row": []})",
                     "bokeh.scales"),
        (Lines{
            "doc.json:1:14: error: bokeh.scales.default has no key 'scael'; did you mean 'scale'?",
            "doc.json:2:24: error: bokeh.scales.rows[0].scale: 10 px is above the maximum 9 px",
            "doc.json:2:51: error: bokeh.scales.rows[1].mode: 'softer' is not one of 'soft' or 'hard'; did "
            "you mean 'soft'?",
            "doc.json:3:24: error: bokeh.scales.rows[2].scale: '1 mm' cannot be converted to px; write "
            "'px'",
            "doc.json:3:32: error: bokeh.scales.rows[2] has no key 'size'",
            "doc.json:3:44: error: bokeh.scales.rows[3] must be an object, not an integer",
            "doc.json:3:48: error: bokeh.scales has no key 'row'; did you mean 'rows'?",
        }));
    EXPECT_EQ(value_faults(spec, "3"),
              Lines{"doc.json:1:1: error: p: expected an object with 'default' and 'rows', not an integer"});
}

TEST(Table, TakesOneKeyARow) {
    const ParamSpec spec = spec_of(kScales);
    const auto row_faults = [&](const std::string& row) {
        return value_faults(spec, "{\"rows\": [" + row + "]}");
    };
    const std::string where = "doc.json:1:11: error: p.rows[0]: ";
    EXPECT_EQ(row_faults("{}"), Lines{where + "a row has one of 'object', 'objects' and 'name', not 0"});
    EXPECT_EQ(row_faults(R"({"object": 1, "name": "a"})"),
              Lines{where + "a row has one of 'object', 'objects' and 'name', not 2"});
    EXPECT_EQ(
        row_faults(R"({"object": -1})"),
        Lines{"doc.json:1:22: error: p.rows[0]: -1 is not an object's id, a number from 0 to 4294967295"});
    EXPECT_EQ(row_faults(R"({"object": 4294967296})"),
              Lines{"doc.json:1:22: error: p.rows[0]: 4294967296 is not an object's id, a number from 0 to "
                    "4294967295"});
    EXPECT_EQ(row_faults(R"({"object": "Wheel"})"),
              Lines{"doc.json:1:22: error: 'object' must be an integer, not a string"});
    EXPECT_EQ(row_faults(R"({"name": ""})"), Lines{"doc.json:1:20: error: p.rows[0]: 'name' is empty"});
    for (const std::string piece : {"7-3", "a", "1-", "", "-1", "1-2-3", "4294967296", "1 2"})
        EXPECT_EQ(row_faults(R"({"objects": "5,)" + piece + "\"}"),
                  Lines{"doc.json:1:23: error: p.rows[0]: '" + piece +
                        "' is not a range of ids; write \"3-7,9\", each from 0 to 4294967295 and rising"});
}

TEST(Table, RefusesTwoRowsForOneObjectAndNamesBoth) {
    const ParamSpec spec = spec_of(kScales);
    EXPECT_EQ(
        value_faults(spec, R"({"rows": [{"objects": "3-7,20"},
 {"object": 5},
 {"name": "a"}, {"name": "b"},
 {"name": "a"}, {"objects": "1-100"}]})"),
        (Lines{
            "doc.json:4:2: error: p.rows[4]: 'a' is taken already by 'a' of p.rows[2], doc.json:3:2",
            "doc.json:4:17: error: p.rows[5]: objects 1-100 is taken already by objects 3-7 of p.rows[0], "
            "doc.json:1:11",
            "doc.json:4:17: error: p.rows[5]: objects 1-100 is taken already by object 5 of p.rows[1], "
            "doc.json:2:2",
            "doc.json:4:17: error: p.rows[5]: objects 1-100 is taken already by object 20 of p.rows[0], "
            "doc.json:1:11",
        }));
    EXPECT_EQ(value_faults(spec, R"({"rows": [{"objects": "3-7,7"}]})"),
              Lines{"doc.json:1:11: error: p.rows[0]: object 7 is taken already by objects 3-7 of p.rows[0], "
                    "doc.json:1:11"});
    EXPECT_EQ(table_of(R"({"rows": [{"objects": "3-7"}, {"object": 8}, {"object": 2}]})").rows.size(), 3u);
}

TEST(Table, HasOnlyColumnsThatABlockCouldHold) {
    const std::string name =
        " must be snake_case: a-z, 0-9 and _, beginning with a letter, and not 'object', 'objects' "
        "or 'name', by which a row says for which object it is";
    EXPECT_EQ(
        spec_faults(R"({"type": "table", "columns": {
"a": {"type": "curve", "default": [[0, 0]], "doc": "."},
"b": {"type": "float", "default": 1, "bind": "define", "from": "camera.x", "requires": ["> a"], "doc": "."},
"name": {"type": "float", "default": 1, "doc": "."},
"C": {"type": "float", "default": 2, "max": 1, "doc": "."}}, "doc": "."})"),
        (Lines{
            "doc.json:2:15: error: 'type' is 'curve' but must be 'float', 'int', 'bool', 'enum', 'angle', "
            "'color', 'vec2', 'vec3' or 'vec4'",
            "doc.json:3:38: error: column 'b' has no key 'bind'; did you mean 'min'?",
            "doc.json:3:56: error: column 'b' has no key 'from'",
            "doc.json:3:76: error: column 'b' has no key 'requires'",
            "doc.json:4:1: error: column 'name'" + name,
            "doc.json:5:1: error: column 'C'" + name,
        }));
    EXPECT_EQ(spec_faults(R"({"type": "table", "columns": {
"c": {"type": "float", "default": 2, "max": 1, "doc": "."}}, "doc": "."})"),
              Lines{"doc.json:2:35: error: p.columns.c.default: 2 is above the maximum 1"});
    EXPECT_EQ(spec_faults(R"({"type": "table", "columns": {}, "min": 0, "doc": "."})"),
              (Lines{"doc.json:1:30: error: a table has at least one column",
                     "doc.json:1:34: " + test::only_numbers_have("min")}));
    EXPECT_EQ(spec_faults(R"({"type": "float", "columns": {}, "default": 0, "doc": "."})"),
              Lines{"doc.json:1:19: error: parameter 'p' has no key 'columns'; it is a key of type 'table'"});
}

TEST(Table, IsFormattedAsADocumentWritesIt) {
    const ParamSpec spec = spec_of(kScales);
    const std::string text =
        R"({"default": {"scale": 2, "tint": [1, 0.5, 0.25], "mode": "hard", "on": false}, "rows": )"
        R"([{"object": 4}, {"objects": "6-9", "mode": "soft", "on": true}, )"
        R"({"name": "A \"b\"", "scale": 1}]})";
    EXPECT_EQ(format_value(spec, value_of(spec, text)), text);
    EXPECT_EQ(format_value(value_of(spec, R"({"rows": [{"object": 4, "scale": 0}]})")),
              R"({"default": {"cells": [1, [1, 0.5, 0.25], 1, 1]}, "rows": [{"object": 4, )"
              R"("cells": [0, [1, 0.5, 0.25], 1, 1]}]})");
}

}  // namespace
}  // namespace aftershade
