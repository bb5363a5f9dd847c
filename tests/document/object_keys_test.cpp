#include "framework/document/object_keys.h"

#include <gtest/gtest.h>

#include "tests/documents.h"

namespace aftershade {
namespace {

using test::Lines;

struct Read {
    std::vector<TableKey> keys;
    Lines faults;
};

Read read(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, "f", diagnostics);
    Read result;
    if (node) result.keys = parse_object_keys(*node, "mask", diagnostics);
    result.faults = test::lines_of(diagnostics);
    return result;
}

using Keys = std::vector<TableKey>;

TEST(ObjectKeys, AreIdsRangesListsAndNames) {
    const std::vector<std::pair<std::string, Keys>> entries = {
        {"0", {{0, 0, ""}}},
        {"4294967295", {{4294967295u, 4294967295u, ""}}},
        {R"("12")", {{12, 12, ""}}},
        {R"("1-8")", {{1, 8, ""}}},
        {R"(" 3 - 7 , 9 ")", {{3, 7, ""}, {9, 9, ""}}},
        {R"("9,3-7,9")", {{9, 9, ""}, {3, 7, ""}, {9, 9, ""}}},
        {R"("Wheel")", {{0, 0, "Wheel"}}},
        {R"("Wheel, left")", {{0, 0, "Wheel, left"}}},
    };
    for (const auto& [text, keys] : entries) {
        EXPECT_EQ(read(text).keys, keys) << text;
        EXPECT_EQ(read(text).faults, Lines{}) << text;
    }
}

TEST(ObjectKeys, OfAnyOtherFormThanIdsAndRangesAreNames) {
    for (const char* name :
         {"3d", "1-", "-1", "1-2-3", "2024-01-15", "1,", ",1", "1,a", "1.5", "+1", "1 2", "-"})
        EXPECT_EQ(read('"' + std::string(name) + '"').keys, (Keys{{0, 0, name}})) << name;
}

TEST(ObjectKeys, ThatAreNoneSayWhy) {
    const std::string form =
        "f:1:1: error: mask: expected an object's id, a range of ids such as \"3-7\" or a name";
    for (const char* text : {"1.5", "true", "[1]", R"("")"}) {
        EXPECT_EQ(read(text).faults, Lines{form}) << text;
        EXPECT_TRUE(read(text).keys.empty()) << text;
    }
    EXPECT_EQ(read("-1").faults,
              Lines{"f:1:1: error: mask: -1 is not an object's id, a number from 0 to 4294967295"});
    for (const char* piece : {"7-3", "4294967296", "1-4294967296"})
        EXPECT_EQ(read(R"("5,)" + std::string(piece) + '"').faults,
                  Lines{"f:1:1: error: mask: '" + std::string(piece) +
                        "' is not a range of ids; write \"3-7,9\", each from 0 to 4294967295 and rising"});
}

TEST(ObjectKeys, AreFormattedAsADocumentWritesThem) {
    for (const char* text : {"3", R"("3-7")", R"("3-7,9")", R"("Wheel")", R"("a \"b\"")"})
        EXPECT_EQ(format_object_keys(read(text).keys), text);
    EXPECT_EQ(object_text({3, 3, ""}), "object 3");
    EXPECT_EQ(object_text({3, 7, ""}), "objects 3-7");
    EXPECT_EQ(object_text({0, 0, "Wheel"}), "'Wheel'");
}

}  // namespace
}  // namespace aftershade
