// Lists of objects as documents write them.
#include <gtest/gtest.h>

#include "tests/document/param_specs.h"

namespace aftershade {
namespace {

using test::Lines;
using test::spec_faults;
using test::spec_of;
using test::value_faults;
using test::value_of;

ParamSpec objects_spec() {
    return spec_of(R"({"type": "objects", "default": [], "doc": "."})");
}

TEST(Objects, AreIdsRangesAndNames) {
    const ParamSpec spec = objects_spec();
    const auto none = std::get<TableValue>(spec.default_value);
    EXPECT_EQ(none.default_row, (TableValue::Row{{1}})) << "an empty list has them all";
    EXPECT_TRUE(none.rows.empty());
    const auto some = std::get<TableValue>(value_of(spec, R"([4294967295, "3-7", " 9 ", "Left ear", "3d"])"));
    const TableValue::Row listed = {{1}};
    const std::vector<std::pair<TableKey, TableValue::Row>> rows = {{{4294967295u, 4294967295u, ""}, listed},
                                                                    {{3, 7, ""}, listed},
                                                                    {{9, 9, ""}, listed},
                                                                    {{0, 0, "Left ear"}, listed},
                                                                    {{0, 0, "3d"}, listed}};
    EXPECT_EQ(some.default_row, (TableValue::Row{{0}}));
    EXPECT_EQ(some.rows, rows);
}

TEST(Objects, SayWhichItemIsWrong) {
    const ParamSpec spec = objects_spec();
    EXPECT_EQ(value_faults(spec, "3"),
              Lines{"doc.json:1:1: error: p: expected an array of objects' ids, ranges such as "
                    "\"3-7\" and names, not an integer"});
    EXPECT_EQ(
        value_faults(spec, R"([-1, 1.5, "", ["a"]])", "sss.object_ids"),
        (Lines{
            "doc.json:1:2: error: sss.object_ids[0]: -1 is not an object's id, a number from 0 to 4294967295",
            "doc.json:1:6: error: sss.object_ids[1]: expected an object's id, a range of ids such as \"3-7\" "
            "or "
            "a name",
            "doc.json:1:11: error: sss.object_ids[2]: expected an object's id, a range of ids such as "
            "\"3-7\" "
            "or a name",
            "doc.json:1:15: error: sss.object_ids[3]: expected an object's id, a range of ids such as "
            "\"3-7\" "
            "or a name"}));
    EXPECT_EQ(
        value_faults(spec, R"([5, "3-7", "a", "a"])"),
        (Lines{"doc.json:1:17: error: p[3]: 'a' is taken already by 'a' of p[2], doc.json:1:12",
               "doc.json:1:5: error: p[1]: objects 3-7 is taken already by object 5 of p[0], doc.json:1:2"}));
}

TEST(Objects, AreFormattedAsADocumentWritesThem) {
    const ParamSpec spec = objects_spec();
    for (const std::string text : {"[]", R"([4, "6-9", "Left \"ear\""])"})
        EXPECT_EQ(format_value(spec, value_of(spec, text)), text);
}

TEST(Objects, HaveNoColumnsNoUnitAndNoSource) {
    EXPECT_EQ(
        spec_faults(
            R"({"type": "objects", "columns": {}, "unit": "mm", "from": "camera.x", "default": [], "doc": "."})"),
        (Lines{"doc.json:1:21: error: parameter 'p' has no key 'columns'; it is a key of type 'table'",
               "doc.json:1:36: " + test::only_numbers_have("unit"),
               "doc.json:1:50: " + test::only_block_types_have("from")}));
}

}  // namespace
}  // namespace aftershade
