#include "framework/golden/golden_decisions.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "framework/base/text.h"
#include "tests/documents.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

std::vector<GoldenDecision> parsed(const std::string& text, Diagnostics& faults) {
    return parse_decisions(text, "decisions.json", faults);
}

TEST(GoldenDecisions, AreReadAsTheyWereWritten) {
    const std::vector<GoldenDecision> decisions{
        {"bloom/lamps", true, true, "", "Ada <ada@example.org>", {{"lamps.color.0001", "12ab", ""}}, true},
        {"lens", false, false, "too dark \"here\" <b>", "Grace", {{"lens.color.0001", "1", "2"}}, false}};
    Diagnostics faults;
    EXPECT_EQ(parsed(decisions_text(decisions), faults), decisions);
    EXPECT_FALSE(faults.has_errors()) << joined(lines_of(faults), "\n", "\n");
}

TEST(GoldenDecisions, TakeTheDocumentsAuthorWhereTheyNameNone) {
    Diagnostics faults;
    const auto decisions = parsed(R"({ "aftershade": 1, "author": "Ada", "decisions": [
        { "case": "a*", "decision": "approve" }, { "case": "b", "decision": "reject", "by": "Grace" } ] })",
                                  faults);
    ASSERT_EQ(decisions.size(), 2u) << joined(lines_of(faults), "\n", "\n");
    EXPECT_EQ(decisions[0].by, "Ada");
    EXPECT_EQ(decisions[1].by, "Grace");
}

TEST(GoldenDecisions, ThatAreNotWellFormedAreFaultsWithTheirPlaces) {
    const auto fault = [](const std::string& decision) {
        Diagnostics faults;
        parsed(R"({ "aftershade": 1, "decisions": [ )" + decision + " ] }", faults);
        return joined(lines_of(faults), "\n", "\n");
    };
    EXPECT_NE(fault(R"({ "case": "a" })").find("decision"), std::string::npos);
    EXPECT_NE(fault(R"({ "case": "a", "decision": "aprove" })").find("did you mean 'approve'"),
              std::string::npos);
    EXPECT_NE(fault(R"({ "case": "a", "decision": "approve", "by": "A\nB" })").find("control character"),
              std::string::npos);
    EXPECT_NE(fault(R"({ "case": "a", "decision": "reject", "note": ")" + std::string(2001, 'x') + "\" }")
                  .find("2001 bytes; the most is 2000"),
              std::string::npos);
    EXPECT_NE(fault(R"({ "case": "a", "decision": "approve", "path": "../x" })").find("no key 'path'"),
              std::string::npos);
}

TEST(GoldenDecisions, OfAMessageAreTheWordsOfItsTags) {
    const auto decisions = decisions_of_message(
        "Widen the lens\n\ngolden: approve bloom/* lens, corner\nnot golden: approve x\ngolden: approved y\n",
        "Ada <ada@example.org>");
    std::vector<std::string> names;
    for (const GoldenDecision& decision : decisions) {
        names.push_back(decision.test);
        EXPECT_TRUE(decision.approves);
        EXPECT_EQ(decision.by, "Ada <ada@example.org>");
    }
    EXPECT_EQ(names, (std::vector<std::string>{"bloom/*", "lens", "corner"}));
}

TEST(GoldenApprovers, AreKnownByTheirAddressAndTheirCases) {
    const TemporaryFolder folder;
    write_text(folder / "approvers.json", R"({ "aftershade": 1, "approvers": [
        { "cases": ["bloom/*"], "who": ["ada@example.org", "Alan"] }, { "who": ["grace@example.org"] } ] })");
    Diagnostics faults;
    const GoldenApprovers approvers = read_approvers(folder / "approvers.json", faults);
    ASSERT_FALSE(faults.has_errors()) << joined(lines_of(faults), "\n", "\n");
    EXPECT_TRUE(approvers.may("Ada <ada@example.org>", "bloom/lamps"));
    EXPECT_FALSE(approvers.may("Ada <ada@example.org>", "lens"));
    EXPECT_TRUE(approvers.may("grace@example.org", "lens")) << "every case by default";
    EXPECT_TRUE(approvers.may("Alan", "bloom/lamps"));
    EXPECT_FALSE(approvers.may("Alan <alan@example.com>", "bloom/lamps")) << "the address counts";
    EXPECT_FALSE(approvers.may("ada@example.org <eve@example.com>", "bloom/lamps"));
    EXPECT_FALSE(approvers.may("", "bloom/lamps"));
    EXPECT_FALSE(approvers.may("Eve <>", "bloom/lamps"));
}

TEST(GoldenApprovers, OfAListWithoutNamesAreNobodyWithAnError) {
    const TemporaryFolder folder;
    for (const auto& [approvers, fault] :
         {std::pair{"[]", "'approvers' is empty, so no one may approve"},
          {R"([ { "cases": ["*"] } ])", "'who' has no address"},
          {R"([ { "who": [] } ])", "'who' has no address"},
          {R"([ { "who": [""] } ])", "'who' has no address"},
          {R"([ { "who": ["ada@example.org"], "cases": [] } ])", "'cases' is empty"}}) {
        SCOPED_TRACE(approvers);
        write_text(folder / "approvers.json",
                   std::string(R"({ "aftershade": 1, "approvers": )") + approvers + " }");
        Diagnostics faults;
        EXPECT_FALSE(read_approvers(folder / "approvers.json", faults).may("ada@example.org", "lens"));
        EXPECT_NE(joined(lines_of(faults), "\n", "\n").find(fault), std::string::npos)
            << joined(lines_of(faults), "\n", "\n");
    }
}

}  // namespace
}  // namespace aftershade::test
