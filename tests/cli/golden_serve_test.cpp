// `golden serve` before there is a page; tests/page/review_page.test.mjs has the page.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

class GoldenServe : public GoldenCommand {
protected:
    void SetUp() override {
        approve();
        write_frame(1, 20);
        EXPECT_EQ(run({"--report", "report"}).exit_code, 2);
    }
};

TEST_F(GoldenServe, RefusesTheSuiteOfAReportFromElsewhere) {
    const TemporaryFolder elsewhere;
    write_text(elsewhere / "golden.json", read_text(folder_ / "golden.json"));
    const std::filesystem::path file = folder_ / "report/report.json";
    Json report = Json::parse(read_text(file));
    for (const std::string& document :
         {(elsewhere / "golden.json").string(), folder_.path().string() + "/../golden.json",
          std::string("/etc/passwd"), std::string()}) {
        report["document"] = document;
        write_text(file, report.dump());
        const CommandResult result = golden({"serve", "report"});
        EXPECT_EQ(result.exit_code, 64) << document;
        EXPECT_NE(result.err.find("name yours: aftershade golden serve SUITE --report report"),
                  std::string::npos)
            << result.err;
    }
}

TEST_F(GoldenServe, SaysWhatIsWrongWithAReportOrItsDecisionsBeforeThereIsAPage) {
    const auto err = [&] {
        const CommandResult result = golden({"serve", "golden.json"});
        EXPECT_EQ(result.exit_code, 4) << result.err;
        EXPECT_EQ(result.out, "");
        return result.err;
    };
    const CommandResult who = golden({"serve", "golden.json", "--approver", std::string(300, 'x')});
    EXPECT_EQ(who.exit_code, 64) << "its decisions would be faults of the file";
    EXPECT_NE(
        who.err.find("the approver's name has 300 bytes; the most is 200; name yourself with --approver"),
        std::string::npos)
        << who.err;
    write_text(folder_ / "report/decisions.json", R"({ "aftershade": 1, "decisions": [ { "case": 3 } ] })");
    EXPECT_NE(err().find("remove it to begin the review again"), std::string::npos);
    std::filesystem::remove(folder_ / "report/decisions.json");
    std::filesystem::create_symlink("/etc/passwd", folder_ / "report/decisions.json");
    EXPECT_NE(err().find("decisions.json"), std::string::npos);
    std::filesystem::remove(folder_ / "report/decisions.json");
    // Of such names no reviewer could read the decisions again.
    const std::string report = read_text(folder_ / "report/report.json");
    for (const auto& [name, fault] : {std::pair{std::string(300, 'x'), "has 300 bytes; the most is 200"},
                                      {std::string("a\nb"), "has a control character"}}) {
        Json changed = Json::parse(report);
        for (Json& test : changed["cases"]) test["images"][0]["name"] = name;
        write_text(folder_ / "report/report.json", changed.dump());
        EXPECT_NE(err().find(fault), std::string::npos) << err();
    }
    write_text(folder_ / "report/report.json", "{}");
    EXPECT_NE(err().find("is not a report of a golden suite"), std::string::npos);
}

}  // namespace
}  // namespace aftershade::test
