#include "framework/document/document.h"

#include <sys/stat.h>

#include <algorithm>

#include "tests/documents.h"
#include "tests/temporary_folder.h"

namespace aftershade {
namespace {

using test::Lines;
using test::lines_of;
using test::parsed;

std::string at(const Place& place) {
    return std::to_string(place.line) + ":" + std::to_string(place.column);
}

/// The faults of a text in a file that is called f.
Lines faults(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, "f", diagnostics);
    EXPECT_EQ(node.has_value(), !diagnostics.has_errors());
    return lines_of(diagnostics);
}

// Positions in these tests are counted by hand, columns from 1 in bytes.

TEST(Document, PlacesAValueAtItsFirstCharacter) {
    const Node root = parsed(
        "{\n"
        "  \"aftershade\": 1,\n"
        "    \"steps\": [ true, false , null,-2.5e3, \"x\" ],\n"
        "  \"nested\": { \"a\": [ [ 7 ] ] }\n"
        "}\n");
    EXPECT_EQ(at(root.place), "1:1");
    ASSERT_EQ(root.members.size(), 3U);
    EXPECT_EQ(at(root.members[0].value.place), "2:17");
    const Node& steps = root.members[1].value;
    EXPECT_EQ(at(steps.place), "3:14");
    ASSERT_EQ(steps.items.size(), 5U);
    EXPECT_EQ(at(steps.items[0].place), "3:16");
    EXPECT_EQ(at(steps.items[1].place), "3:22");
    EXPECT_EQ(at(steps.items[2].place), "3:30");
    EXPECT_EQ(at(steps.items[3].place), "3:35");
    EXPECT_EQ(at(steps.items[4].place), "3:43");
    const Node& nested = root.members[2].value;
    EXPECT_EQ(at(nested.place), "4:13");
    const Node& outer = *nested.find("a");
    EXPECT_EQ(at(outer.place), "4:20");
    EXPECT_EQ(at(outer.items[0].place), "4:22");
    EXPECT_EQ(at(outer.items[0].items[0].place), "4:24");
    EXPECT_EQ(root.place.file, "doc.json");
}

TEST(Document, PlacesAKeyAtItsOpeningQuote) {
    const Node root = parsed("{ \"a\" :1,\n\t\"b\": {\"c\":2,\"d\":3}}");
    EXPECT_EQ(at(root.members[0].key_place), "1:3");
    EXPECT_EQ(at(root.members[1].key_place), "2:2");
    const Node& inner = root.members[1].value;
    EXPECT_EQ(at(inner.members[0].key_place), "2:8");
    EXPECT_EQ(at(inner.members[1].key_place), "2:14");
}

TEST(Document, PlacesStringsThatHoldQuotesAndBackslashes) {
    const Node root = parsed(R"({"a\"b": "c\\", "\\": "\u00e9\n\"", "": ""})");
    ASSERT_EQ(root.members.size(), 3U);
    EXPECT_EQ(root.members[0].key, "a\"b");
    EXPECT_EQ(at(root.members[0].key_place), "1:2");
    EXPECT_EQ(root.members[0].value.string, "c\\");
    EXPECT_EQ(at(root.members[0].value.place), "1:10");
    EXPECT_EQ(root.members[1].key, "\\");
    EXPECT_EQ(at(root.members[1].key_place), "1:17");
    EXPECT_EQ(root.members[1].value.string, "\u00e9\n\"");
    EXPECT_EQ(at(root.members[1].value.place), "1:23");
    EXPECT_EQ(at(root.members[2].key_place), "1:37");
    EXPECT_EQ(at(root.members[2].value.place), "1:41");
}

TEST(Document, HoldsNoTextWithAZeroByte) {
    EXPECT_EQ(faults(R"({ "mask": { "file": "mask.png\u0000zz" } })"),
              Lines{"f:1:21: error: a text holds no zero byte (\\u0000)"});
}

TEST(Document, PlacesNumbersWhereverTheyEnd) {
    EXPECT_EQ(at(parsed("42").place), "1:1");
    EXPECT_EQ(at(parsed("\n  -1.5").place), "2:3");
    EXPECT_EQ(at(parsed(" 7 \n").place), "1:2");
    const Node list = parsed("[1,22,333\n,4e0]");
    EXPECT_EQ(at(list.items[0].place), "1:2");
    EXPECT_EQ(at(list.items[1].place), "1:4");
    EXPECT_EQ(at(list.items[2].place), "1:7");
    EXPECT_EQ(at(list.items[3].place), "2:2");
}

TEST(Document, CountsThePlacesOfCommentsAndLineEndings) {
    EXPECT_EQ(at(parsed("// one 1\n/* 2\n 3 */ 4 // 5").place), "3:7");
    EXPECT_EQ(at(parsed("{ \"a\": // why \"\\\n 5 }").find("a")->place), "2:2");
    EXPECT_EQ(at(parsed("[/*9*/8/*7*/]").items[0].place), "1:7");
    const Node windows = parsed("{\r\n  \"a\": 1,\r\n  \"b\": true\r\n}\r\n");
    EXPECT_EQ(at(windows.members[0].value.place), "2:8");
    EXPECT_EQ(at(windows.members[1].key_place), "3:3");
    EXPECT_EQ(at(windows.members[1].value.place), "3:8");
}

TEST(Document, CountsColumnsInBytesAndNotTheByteOrderMark) {
    EXPECT_EQ(at(parsed("{\"\u00e9\": 1}").members[0].value.place), "1:8");
    const Node marked = parsed("\xEF\xBB\xBF{\"a\": 1}");
    EXPECT_EQ(at(marked.place), "1:1");
    EXPECT_EQ(at(marked.members[0].key_place), "1:2");
}

TEST(Document, KeepsIntegersApartFromNumbers) {
    const Node list = parsed("[1, 1.0, 9223372036854775807, 9223372036854775808, -9223372036854775808, 1e2]");
    EXPECT_EQ(list.items[0].kind, Node::Kind::integer);
    EXPECT_EQ(list.items[0].number, 1.0);
    EXPECT_EQ(list.items[1].kind, Node::Kind::number);
    EXPECT_EQ(list.items[2].integer, INT64_MAX);
    EXPECT_EQ(list.items[3].kind, Node::Kind::number);
    EXPECT_EQ(list.items[3].number, 9223372036854775808.0);
    EXPECT_EQ(list.items[4].integer, INT64_MIN);
    EXPECT_EQ(list.items[5].number, 100.0);
}

TEST(Document, RefusesAKeyThatStandsTwice) {
    const Lines twice = {"f:3:3: error: the key 'a' occurs twice in one object; first at line 1"};
    EXPECT_EQ(faults("{ \"a\": 1,\n  \"b\": {\"a\": 2},\n  \"a\": 3 }"), twice);
    const Lines escaped = {"f:1:9: error: the key 'a' occurs twice in one object; first at line 1"};
    EXPECT_EQ(faults(R"({"a":1, "\u0061":2})"), escaped);
}

TEST(Document, KeepsTheLastOfAtMostAHundredEqualKeys) {
    for (const int count : {100, 101}) {
        std::string text = "{\"a\": 0";
        for (int i = 1; i <= count; ++i) text += ",\n\"a\": " + std::to_string(i);
        Diagnostics diagnostics;
        const auto document = parse_document(text + "}", "f", diagnostics, SameKeys::keep_last);
        ASSERT_EQ(document.has_value(), count == 100);
        EXPECT_EQ(diagnostics.error_count(), count - 100);
        if (!document) {
            EXPECT_EQ(diagnostics.all().back().place.line, 102);
            continue;
        }
        ASSERT_EQ(document->members.size(), 1U);
        EXPECT_EQ(document->members[0].value.integer, 100);
    }
}

TEST(Document, NestsUpToSixtyFourLevels) {
    const auto arrays = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_EQ(faults(arrays(64)), Lines{});
    const Lines too_deep = {"f:1:65: error: nested deeper than 64 levels"};
    EXPECT_EQ(faults(arrays(65)), too_deep);
    EXPECT_EQ(faults(std::string(1000000, '[')), too_deep);
    std::string objects;
    for (int i = 0; i < 65; ++i) objects += "{\"a\":";
    const Lines too_deep_object = {"f:1:321: error: nested deeper than 64 levels"};  // 64 * 5 + 1
    EXPECT_EQ(faults(objects), too_deep_object);
}

struct SyntaxFault {
    std::string text;
    std::string place;
    std::string message;  ///< a part of it
};

const std::vector<SyntaxFault> kSyntaxFaults = {
    {"", "f:1:1", "unexpected end of input"},
    {"\n\n", "f:3:1", "unexpected end of input"},
    {"{\"a\": 1", "f:1:8", "unexpected end of input"},
    {"\"abc", "f:1:5", "missing closing quote"},
    {"[1, 2", "f:1:6", "unexpected end of input"},
    {"{\"a\": 1,}", "f:1:9", "unexpected '}'"},
    {"{\n  \"a\": 1\n  \"bcd\": 2 }", "f:3:3", "unexpected string literal"},
    {"{\"a\": 1 true}", "f:1:9", "unexpected true literal"},
    {"{\"a\" 17}", "f:1:6", "unexpected number literal"},
    {"[1] -2.5", "f:1:5", "unexpected number literal"},
    {"{'a': 1}", "f:1:2", "invalid literal"},
    {"{\"a\": tru}", "f:1:10", "invalid literal"},
    {"[01]", "f:1:2", "unexpected number literal"},  // the word 01
    {"{\"a\": NaN}", "f:1:7", "invalid literal"},
    {"\"a\nb\"", "f:1:3", "control character"},
    {"\"\\q\"", "f:1:3", "forbidden character after backslash"},
    {"[1e999]", "f:1:2", "number overflow parsing '1e999'"},
    {"{\"a\": -1e400 }", "f:1:7", "number overflow"},
    {"\"a\xFF\"", "f:1:3", "ill-formed UTF-8 byte"},
    {"\"\xC0\xAF\"", "f:1:2", "ill-formed UTF-8 byte"},  // an overlong slash
    {"\xFF\xFE{", "f:1:1", "invalid literal"},           // UTF-16's mark
    {"/* open", "f:1:8", "missing closing"},
};

TEST(Document, StopsAtTheFirstSyntaxFaultAndNamesItsPlace) {
    for (const SyntaxFault& fault : kSyntaxFaults) {
        const Lines lines = faults(fault.text);
        ASSERT_EQ(lines.size(), 1U) << fault.text;
        EXPECT_EQ(lines[0].substr(0, fault.place.size() + 9), fault.place + ": error: ") << lines[0];
        EXPECT_NE(lines[0].find(fault.message), std::string::npos) << lines[0];
        EXPECT_EQ(lines[0].find("json.exception"), std::string::npos) << lines[0];
    }
}

TEST(Document, RefusesNulBytesWhereverTheyStand) {
    using namespace std::string_literals;
    const Lines after = {"f:1:3: error: a NUL byte: a document is UTF-8 text"};
    EXPECT_EQ(faults("{}\0{\"never\": \"read\"}"s), after);
    const Lines inside = {"f:2:4: error: a NUL byte: a document is UTF-8 text"};
    EXPECT_EQ(faults("{\n// \0\n}"s), inside);
}

TEST(Document, RefusesMoreThanOneMebibyte) {
    EXPECT_EQ(faults("1" + std::string(1024 * 1024 - 1, ' ')), Lines{});
    const Lines too_large = {"f: error: is larger than 1048576 bytes"};
    EXPECT_EQ(faults("1" + std::string(1024 * 1024, ' ')), too_large);
}

Lines read_faults(const std::filesystem::path& path) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_document(path, diagnostics).has_value());
    return lines_of(diagnostics);
}

TEST(Document, ReadsOnlyRegularFilesOfAReasonableSize) {
    const test::TemporaryFolder folder;
    const auto line = [](const std::filesystem::path& path, const std::string& message) {
        return Lines{path.string() + message};
    };
    EXPECT_EQ(read_faults(folder / "none.json"), line(folder / "none.json", ": error: no such file"));
    EXPECT_EQ(read_faults(folder.path()), line(folder.path(), ": error: is not a regular file"));

    const auto pipe = folder / "pipe.json";  // opening it would wait for a writer
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(read_faults(pipe), line(pipe, ": error: is not a regular file"));

    const auto huge = folder / "huge.json";
    test::write_text(huge, "{}");
    std::filesystem::resize_file(huge, std::uintmax_t(1) << 40);
    EXPECT_EQ(read_faults(huge),
              line(huge, ": error: the file has 1099511627776 bytes, the limit is 1048576"));

    const auto empty = folder / "empty.json";
    test::write_text(empty, "");
    ASSERT_EQ(read_faults(empty).size(), 1U);
    EXPECT_TRUE(read_faults(empty)[0].starts_with(empty.string() + ":1:1: error: ")) << read_faults(empty)[0];
}

TEST(Document, ReadsAFileThroughALink) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "real.json", "{\"a\": [1]}");
    std::filesystem::create_symlink(folder / "real.json", folder / "link.json");
    Diagnostics diagnostics;
    const auto node = read_document(folder / "link.json", diagnostics);
    ASSERT_TRUE(node.has_value());
    EXPECT_EQ(node->find("a")->place.file, (folder / "link.json").string());
}

}  // namespace
}  // namespace aftershade
