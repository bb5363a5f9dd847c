// What `golden comment` makes of a report, its own and a stranger's.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <regex>

#include "framework/base/text.h"
#include "framework/file/png_file.h"
#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

class GoldenComment : public GoldenCommand {
protected:
    /// A report of one case that fails and one that passes.
    void report_a_failure() {
        approve();
        change_image(image("corner.color.0001"), [](Image& pixels) { pixels.at(31, 17, 2) += 0.5f; });
        EXPECT_EQ(run({"--report", "report"}).exit_code, 2);
    }
    CommandResult comment(std::vector<std::string> words = {}) {
        words.insert(words.begin(), {"comment", "report"});
        return golden(words);
    }
    /// Another program's hand in report.json.
    template <typename Change>
    void change_report(Change change) {
        Json report = Json::parse(read_text(folder_ / "report/report.json"));
        change(report);
        write_text(folder_ / "report/report.json", report.dump());
    }
};

TEST_F(GoldenComment, NamesWhatDiffersByHowMuchWhereAndWhatApprovesIt) {
    report_a_failure();
    const CommandResult result = comment();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(result.out.starts_with("<!-- aftershade golden: golden.json -->\n")) << result.out;
    EXPECT_NE(result.out.find("1 failed, 0 with warnings, 1 as approved"), result.out.npos) << result.out;
    EXPECT_TRUE(std::regex_search(
        result.out,
        std::regex(
            R"(\| `corner` \| `corner\.color\.0001` \| failure \| `0\.5 at \(31, 17\) B` \| 0\.0434 % \|)")))
        << result.out;
    EXPECT_NE(result.out.find("aftershade golden approve golden.json --filter corner"), result.out.npos);
    EXPECT_EQ(result.out.find("lens"), result.out.npos) << "what passes is not listed";
    EXPECT_FALSE(std::filesystem::exists(folder_ / "report/thumbnails.png"));
}

TEST_F(GoldenComment, ShowsThumbnailsFromTheUrlThatServesTheReport) {
    report_a_failure();
    const CommandResult result = comment({"--pictures-url", "https://ci.example/7", "-o", "comment.md"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(read_text(folder_ / "comment.md").find("(https://ci.example/7/thumbnails.png)"),
              std::string::npos);
    const Image sheet = read_png(folder_ / "report/thumbnails.png");
    EXPECT_EQ(sheet.width(), 3 * 240 + 2 * 4);
    // The difference is of one pixel alone, in the third column.
    const Image difference = read_png(folder_ / "report/images/corner.color.0001.difference.png");
    EXPECT_LE(sheet.height(), 184);
    float most = 0;
    for (int y = 0; y < sheet.height(); ++y)
        for (int x = 488; x < sheet.width(); ++x) most = std::max(most, sheet.at(x, y, 2));
    EXPECT_GT(most, 0.0f);
}

TEST_F(GoldenComment, OfARunThatPassesIsOneLine) {
    approve();
    EXPECT_EQ(run({"--report", "report"}).exit_code, 0);
    const CommandResult result = comment();
    EXPECT_NE(result.out.find("### Golden images: 2 cases as approved\n"), result.out.npos) << result.out;
    EXPECT_EQ(result.out.find("|"), result.out.npos);
}

TEST_F(GoldenComment, OfARunThatEndedEarlySaysWhy) {
    write_text(folder_ / "golden.json", "{ \"aftershade\": 1, \"cases\": 3 }");
    EXPECT_EQ(run({"--report", "report"}).exit_code, 64);
    const CommandResult result = comment();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("the run ended early"), result.out.npos) << result.out;
    EXPECT_NE(result.out.find("'cases'"), result.out.npos) << result.out;
    change_report([](Json& report) { report["error"] = "a.json: error: one\nb.json: error: two\n```\n<b>"; });
    EXPECT_NE(comment().out.find("\n````\na.json: error: one\nb.json: error: two\n```\n<b>\n````\n"),
              result.out.npos)
        << comment().out;
}

TEST_F(GoldenComment, AnnotatesTheDocumentOfTheCaseAndWritesSarif) {
    report_a_failure();
    const CommandResult result = comment({"--annotations", "--sarif", "golden.sarif"});
    EXPECT_TRUE(result.out.starts_with(
        "::error file=golden.json,title=golden corner::corner.color.0001: RGB: 1 pixel"))
        << result.out;
    const Json sarif = Json::parse(read_text(folder_ / "golden.sarif"));
    EXPECT_EQ(sarif["version"], "2.1.0");
    const Json& found = sarif["runs"][0]["results"];
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0]["ruleId"], sarif["runs"][0]["tool"]["driver"]["rules"][0]["id"]);
    const Json& place = found[0]["locations"][0]["physicalLocation"];
    EXPECT_EQ(place["artifactLocation"]["uri"], "golden.json");
    EXPECT_EQ(place["region"]["startLine"], 1);
}

TEST_F(GoldenComment, OfAStrangersReportHasNoMarkdownButItsOwn) {
    report_a_failure();
    write_text(folder_ / "secret.png", "secret");
    change_report([](Json& report) {
        report["suite"] = "x --> <img src=x>";
        Json& test = report["cases"][1];
        test["name"] = "a` | @everyone\n# big <script>";
        test["file"] = "a b:c,d\n::error::x";
        test["images"][0]["pictures"]["test"] = "../secret.png";
        test["images"][0]["pictures"]["reference"] = "/etc/passwd";
    });
    const CommandResult result = comment({"--pictures-url", "u"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("`a' \\| @everyone?# big <script>`"), result.out.npos) << result.out;
    EXPECT_EQ(result.out.find("<img"), result.out.npos);
    EXPECT_EQ(result.out.find("\n# big"), result.out.npos);
    const CommandResult annotated = comment({"--annotations"});
    EXPECT_EQ(std::count(annotated.out.begin(), annotated.out.end(), '\n'), 1) << annotated.out;
}

TEST_F(GoldenComment, NamesFiguresThatJsonLacks) {
    report_a_failure();
    for (const auto& [value, shown] :
         {std::pair{"nan", "`NaN at (31, 17) B`"}, {"inf", "`inf at (31, 17) B`"}}) {
        change_report([&](Json& report) {
            Json& layer = report["cases"][1]["images"][0]["comparison"]["layers"][0];
            layer["max_error"] = {{"value", value}, {"x", 31}, {"y", 17}, {"channel", "B"}};
            layer["failing"]["percent"] = value;
            report["counts"]["failed"] = 1e300;
        });
        const CommandResult result = comment({"--sarif", "golden.sarif"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.out.find(shown), result.out.npos) << result.out;
        EXPECT_TRUE(Json::accept(read_text(folder_ / "golden.sarif")));
    }
    for (const float value : {std::numeric_limits<float>::infinity(), std::nanf("")}) {
        change_image(image("corner.color.0001"), [&](Image& pixels) { pixels.at(31, 17, 2) = value; });
        EXPECT_EQ(run({"--report", "report"}).exit_code, 2);
        const CommandResult result = comment();
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.out.find(" at (31, 17) B`"), result.out.npos) << result.out;
    }
}

TEST_F(GoldenComment, IsCutBetweenLinesAndCharacters) {
    report_a_failure();
    change_report([](Json& report) {
        std::string name;
        for (int i = 0; i < 120; ++i) name += "ä€|";
        report["suite"] = std::string(299, '&') + "<" + name;
        Json test = report["cases"][1];
        test["name"] = "x" + name;
        test["images"][0]["verdict"] = "<b>";
        for (int i = 0; i < 400; ++i) report["cases"].push_back(test);
        for (int i = 0; i < 400; ++i) report["orphans"].push_back(name);
        report["approve"] = std::string(100'000, 'x');
    });
    const CommandResult result = comment({"--rows", "1000"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_LE(result.out.size(), 60'000u);
    EXPECT_GE(result.out.size(), 50'000u);
    EXPECT_EQ(printable_lines(result.out), result.out) << "UTF-8";
    EXPECT_EQ(result.out.find('?'), result.out.npos) << "no character is cut";
    EXPECT_NE(result.out.find(" | `<b>` | "), result.out.npos) << "a verdict of another program is code";
    EXPECT_NE(result.out.find(" more in the report.\n"), result.out.npos);
    EXPECT_NE(result.out.find("The command to approve is in the report."), result.out.npos);
    for (const std::string& line : lines_of_text(result.out))
        if (line.starts_with("| `")) EXPECT_TRUE(line.ends_with("` |")) << line;
}

TEST_F(GoldenComment, OfWhatIsNoReportIsAFileError) {
    std::filesystem::create_directories(folder_ / "report");
    EXPECT_EQ(comment().exit_code, 4);
    for (const char* text :
         {"{}", "[]", "{", R"({"suite": "s", "cases": [{"verdict": 3}], "orphans": []})"}) {
        write_text(folder_ / "report/report.json", text);
        const CommandResult result = comment();
        EXPECT_EQ(result.exit_code, 4) << text << result.err;
        EXPECT_NE(result.err.find("is not a report of a golden suite"), result.err.npos) << result.err;
    }
    write_text(folder_ / "report/report.json", "{}");
    EXPECT_EQ(comment({"-o", "report/report.json"}).exit_code, 64) << "the report itself stays";
}

}  // namespace
}  // namespace aftershade::test
