#include "framework/base/text.h"

#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aftershade {
namespace {

std::uint64_t hash(const std::string& text) {
    return fnv1a(std::as_bytes(std::span(text)));
}

// The vectors of the authors' own test suite (http://www.isthe.com/chongo/src/fnv/test_fnv.c).
TEST(Fnv1a, GivesThePublishedHashes) {
    EXPECT_EQ(hash(""), 0xcbf29ce484222325ull);
    EXPECT_EQ(hash("a"), 0xaf63dc4c8601ec8cull);
    EXPECT_EQ(hash("foobar"), 0x85944171f73967e8ull);
}

TEST(Fnv1a, GoesOnWhereItEnded) {
    const std::string tail = "bar";
    EXPECT_EQ(fnv1a(std::as_bytes(std::span(tail)), hash("foo")), hash("foobar"));
}

TEST(Fnv1a, OfTextsIsTheSame) {
    EXPECT_EQ(fnv1a("foobar"), hash("foobar"));
    EXPECT_EQ(fnv1a_hex("foobar"), "85944171f73967e8");
    EXPECT_EQ(fnv1a_hex(std::string_view("0\0", 2)).size(), 16u);
    EXPECT_EQ(fnv1a_32(""), 0x811c9dc5u);
    EXPECT_EQ(fnv1a_32("foobar"), 0xbf9cf968u);
}

TEST(Pieces, StandBetweenTheSeparators) {
    using Pieces = std::vector<std::string_view>;
    EXPECT_EQ(split("", ','), Pieces{""});
    EXPECT_EQ(split("a", ','), Pieces{"a"});
    EXPECT_EQ(split(",a,,b,", ','), (Pieces{"", "a", "", "b", ""}));
    EXPECT_EQ(trimmed("  a b "), "a b");
    EXPECT_EQ(trimmed("   "), "");
}

TEST(Pieces, AreJoinedAsASentenceHasThem) {
    const std::vector<std::string> words = {"a", "b", "c"};
    EXPECT_EQ(joined({}, " and "), "");
    EXPECT_EQ(joined(std::span(words).first(1), " and "), "a");
    EXPECT_EQ(joined(words, " and "), "a, b and c");
    EXPECT_EQ(joined(words, "\n", "\n"), "a\nb\nc");
}

TEST(LowerCase, ChangesAsciiLettersAlone) {
    EXPECT_EQ(lower_case("aZ.[@`{ \u00c4\xff"), "az.[@`{ \u00c4\xff");
}

TEST(TextFor, PeopleHasNoControlCharacters) {
    EXPECT_EQ(printable("Gr\u00f6\u00dfe \u4e2d \U0001f600"), "Gr\u00f6\u00dfe \u4e2d \U0001f600");
    EXPECT_EQ(printable("a\x1b[31mb\n\x7f"), "a?[31mb??");
    EXPECT_EQ(printable("\u0085"), "??") << "a control character of two bytes";
    // RFC 3629: a byte that begins nothing, one cut off, one longer than it need be, half of a pair.
    EXPECT_EQ(printable("\xff|\xe4\xb8|\xc0\xaf|\xed\xa0\x80"), "?|??|??|???");
}

TEST(TextFor, JsonIsOneLineOfUtf8) {
    EXPECT_EQ(json_string("a \"b\"\n\\"), R"("a \"b\"\n\\")");
    EXPECT_EQ(json_string("\xff"), "\"\ufffd\"");
}

TEST(TextFor, XmlHasNothingThatWouldBeMarkup) {
    EXPECT_EQ(xml_text("a<b>&\"c\" 'd'"), "a&lt;b&gt;&amp;&quot;c&quot; 'd'");
    EXPECT_EQ(xml_text("a\tb\nc\x01"), "a\tb&#10;c?");
    EXPECT_EQ(xml_text("mm\u00b2\xff\uffff"), "mm\u00b2????");
}

TEST(TextFor, ACommandThatIsPrintedIsOneLineThatBashReadsBack) {
    std::vector<std::string> words{
        "/bin/echo", "-n",           "",       "a b",          "it's",         "$HOME \"*\" `x` \\n !!",
        "-dash",     "--",           "~",      "a=b c",        "line\nline\n", "\033[2J\x7f\r\t",
        "\xff'\\8",  "\u00e4\u00a0", "\u0085", "#;&|<>(){}[]?"};
    const std::string command = printed_command(words);
    EXPECT_EQ(printable(command), command) << "nothing that a terminal acts on";
    words[0] = "printf";
    words[1] = "%s\\0";
    const std::string script = printed_command(words);
    FILE* const pipe = popen(("exec bash -c " + shell_line({script})).c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string read;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) read += char(c);
    EXPECT_EQ(pclose(pipe), 0);
    std::string expected;
    for (std::size_t i = 2; i < words.size(); ++i) expected += words[i] + '\0';
    EXPECT_EQ(read, expected);
    EXPECT_EQ(printed_command({"run", "a/b.exr", "a b"}), "run a/b.exr 'a b'");
}

TEST(TextFor, AShellIsQuotedWhereItMustBe) {
    EXPECT_EQ(shell_line({"aftershade", "run", "a/b-c_1.exr", "--set", "x.y=1,2"}),
              "aftershade run a/b-c_1.exr --set x.y=1,2");
    EXPECT_EQ(shell_line({"", "a b", "it's", "$HOME", "*"}), "'' 'a b' 'it'\\''s' '$HOME' '*'");
    EXPECT_EQ(shell_line({}), "");
}

TEST(SnakeCase, BeginsWithALetterAndHasNoCapitals) {
    for (const char* name : {"a", "a1", "near_tile", "a_"}) EXPECT_TRUE(is_snake_case(name)) << name;
    for (const char* name : {"", "_a", "1a", "nearTile", "a-b", "a b", "\xc3\xa4"})
        EXPECT_FALSE(is_snake_case(name)) << name;
}

}  // namespace
}  // namespace aftershade
