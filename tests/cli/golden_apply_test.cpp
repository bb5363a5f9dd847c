#include <gtest/gtest.h>

#include <filesystem>

#include "framework/golden/approved_image.h"
#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

/// A suite whose two cases draw other images than those approved.
class GoldenApply : public GoldenCommand {
protected:
    GoldenApply() {
        approve();
        write_text(folder_ / "approvers.json",
                   R"({ "aftershade": 1, "approvers": [ { "who": ["ada@example.org"] } ] })");
        write_frame(1, 20);
        write_frame(2, 20);
        before_ = contents(folder_ / "goldens");
    }

    CommandResult apply(std::vector<std::string> words) {
        words.insert(words.begin(), {"apply-approvals", "golden.json"});
        return golden(words);
    }
    /// A decision about the images that a report shows, as its page downloads it.
    Json seen(const std::string& name, const char* decision = "approve") {
        const Json report = Json::parse(read_text(folder_ / "report/report.json"));
        Json images = Json::array();
        for (const Json& image : case_of(report, name)["images"])
            images.push_back({{"name", image["name"]},
                              {"test", image["hashes"]["test"]},
                              {"reference", image["hashes"]["reference"]}});
        return {{"case", name}, {"decision", decision}, {"by", "Ada <ada@example.org>"}, {"images", images}};
    }
    void write_decisions(const Json& decisions) {
        write_text(folder_ / "decisions.json", Json{{"aftershade", 1}, {"decisions", decisions}}.dump());
    }
    void git(std::vector<std::string> words) {
        words.insert(words.begin(), {"/usr/bin/git", "-c", "user.name=Ada", "-c",
                                     "user.email=ada@example.org", "-c", "init.defaultBranch=main"});
        ASSERT_EQ(Command(words, folder_.path()).wait().exit_code, 0);
    }
    std::string approver(const std::string& name) {
        return Json::parse(read_text(sidecar_path(image(name))))["approver"];
    }

    std::map<std::string, std::string> before_;
};

TEST_F(GoldenApply, TakesTheTagsOfCommitsAndTheirAuthor) {
    git({"init", "-q"});
    git({"commit", "-q", "--allow-empty", "-m", "Widen the lens\n\ngolden: approve cor*"});
    const CommandResult result = apply({"--commits", "HEAD"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "goldens/corner.color.0001.exr\n");
    EXPECT_EQ(approver("corner.color.0001"), "Ada <ada@example.org>");
    EXPECT_EQ(run({"--filter", "corner"}).exit_code, 0);
    EXPECT_EQ(run({"--filter", "lens"}).exit_code, 2);
    EXPECT_EQ(apply({"--commits", "main..HEAD"}).exit_code, 64) << "no commit in this range";
    EXPECT_EQ(apply({"--commits", "--output=x"}).exit_code, 64);
    EXPECT_FALSE(fs::exists(folder_ / "x")) << "a revision is not an option of git";
}

TEST_F(GoldenApply, OfAReportsDecisionsWritesWhatApproveWrites) {
    EXPECT_EQ(run({"--report", "report"}).exit_code, 2);
    write_decisions({seen("corner"), seen("lens")});
    const CommandResult result = apply({"decisions.json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto applied = contents(folder_ / "goldens");
    EXPECT_NE(applied, before_);
    fs::remove_all(folder_ / "goldens");
    approve({"--approver", "Ada <ada@example.org>"});
    EXPECT_EQ(contents(folder_ / "goldens"), applied);
}

TEST_F(GoldenApply, KeepsTheGoldensOfACaseThatDrawsAnotherPictureThanWasSeen) {
    EXPECT_EQ(run({"--report", "report"}).exit_code, 2);
    write_decisions({seen("corner"), seen("lens")});
    write_frame(2, 10);  // of lens alone
    const CommandResult result = apply({"decisions.json"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "goldens/corner.color.0001.exr\n");
    EXPECT_NE(result.err.find("lens.color.0002: the case draws another picture here"), std::string::npos)
        << result.err;
}

TEST_F(GoldenApply, KeepsAGoldenThatSomeoneElseHasApprovedSinceTheReview) {
    EXPECT_EQ(run({"--report", "report"}).exit_code, 2);
    write_decisions(Json::array({seen("corner")}));
    change_image(image("corner.color.0001"), [](Image& pixels) {
        for (float& value : pixels.floats()) value *= 0.5f;
    });
    const auto theirs = contents(folder_ / "goldens");
    const CommandResult result = apply({"decisions.json"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("another image was approved since the review"), std::string::npos)
        << result.err;
    EXPECT_EQ(contents(folder_ / "goldens"), theirs);
}

TEST_F(GoldenApply, TakesTheSameDecisionsTwice) {
    EXPECT_EQ(run({"--report", "report"}).exit_code, 2);
    write_decisions({seen("corner"), seen("lens")});
    EXPECT_EQ(apply({"decisions.json"}).exit_code, 0);
    const auto applied = contents(folder_ / "goldens");
    const CommandResult again = apply({"decisions.json"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(contents(folder_ / "goldens"), applied);
}

TEST_F(GoldenApply, WritesNothingWhereOneDecisionIsOfSomeoneWhoMayNot) {
    write_decisions(
        {{{"case", "corner"}, {"decision", "approve"}, {"by", "Ada <ada@example.org>"}},
         {{"case", "lens"}, {"decision", "approve"}, {"by", "ada@example.org <eve@example.com>"}}});
    const CommandResult result = apply({"decisions.json"});
    EXPECT_EQ(result.exit_code, 64);
    EXPECT_NE(result.err.find("may not decide about it; approvers.json names who may"), std::string::npos)
        << result.err;
    EXPECT_EQ(contents(folder_ / "goldens"), before_);
    EXPECT_EQ(apply({"decisions.json", "--author", "Eve <eve@example.com>"}).exit_code, 64)
        << "a bot's word counts, not the file's";
    EXPECT_EQ(apply({"decisions.json", "--author", "Ada <ada@example.org>"}).exit_code, 0);
    EXPECT_EQ(approver("lens.color.0001"), "Ada <ada@example.org>");
}

TEST_F(GoldenApply, NeedsAListOfWhoMayApprove) {
    fs::remove(folder_ / "approvers.json");
    write_decisions(Json::array({{{"case", "corner"}, {"decision", "approve"}, {"by", "ada@example.org"}}}));
    const CommandResult result = apply({"decisions.json"});
    EXPECT_EQ(result.exit_code, 64);
    EXPECT_NE(result.err.find("approvers.json"), std::string::npos) << result.err;
    EXPECT_EQ(contents(folder_ / "goldens"), before_);
    write_text(folder_ / "base.json",
               R"({ "aftershade": 1, "approvers": [ { "who": ["ada@example.org"] } ] })");
    EXPECT_EQ(apply({"decisions.json", "--approvers", "base.json"}).exit_code, 0);
}

TEST_F(GoldenApply, RefusesOptionsAndListsThatAreEmpty) {
    write_decisions(Json::array({{{"case", "corner"}, {"decision", "approve"}, {"by", "ada@example.org"}}}));
    for (const char* option : {"--approvers", "--author", "--commits"}) {
        const CommandResult result = apply({"decisions.json", option, ""});
        EXPECT_EQ(result.exit_code, 64) << option;
        EXPECT_NE(result.err.find(std::string(option) + ": is empty"), std::string::npos) << result.err;
    }
    write_text(folder_ / "approvers.json", R"({ "aftershade": 1, "approvers": [] })");
    const CommandResult nobody = apply({"decisions.json"});
    EXPECT_EQ(nobody.exit_code, 64);
    EXPECT_NE(nobody.err.find("no one may approve; write \"approvers\": [{"), std::string::npos)
        << nobody.err;
    EXPECT_EQ(contents(folder_ / "goldens"), before_);
}

TEST_F(GoldenApply, SaysWhichTagsDoNotCountAfterARevert) {
    git({"init", "-q"});
    git({"commit", "-q", "--allow-empty", "-m", "Begin"});
    git({"tag", "begin"});
    git({"commit", "-q", "--allow-empty", "-m", "Widen\n\ngolden: approve lens"});
    git({"commit", "-q", "--allow-empty", "-m", "Revert \"Widen\"\n\ngolden: approve lens"});
    const CommandResult result = apply({"--commits", "begin..HEAD"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("is reverted by a later commit"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("no decision: nothing was written"), std::string::npos) << result.err;
    EXPECT_EQ(contents(folder_ / "goldens"), before_);
}

TEST_F(GoldenApply, EndsWithAFailureWhereACaseIsRejected) {
    write_decisions(
        {{{"case", "corner"}, {"decision", "approve"}, {"by", "ada@example.org"}},
         {{"case", "lens"}, {"decision", "reject"}, {"by", "ada@example.org"}, {"note", "blurred"}}});
    const CommandResult result = apply({"decisions.json"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "goldens/corner.color.0001.exr\n");
    EXPECT_NE(result.err.find("REJECTED lens by ada@example.org: blurred"), std::string::npos) << result.err;
}

TEST_F(GoldenApply, OfAHostileFileWritesNothing) {
    const auto all = contents(folder_.path());
    const auto refuses = [&](const std::string& text, const std::string& why) {
        write_text(folder_ / "hostile.json", text);
        const CommandResult result = apply({"hostile.json"});
        EXPECT_EQ(result.exit_code, 64) << text.substr(0, 200);
        EXPECT_NE(result.err.find(why), std::string::npos) << result.err.substr(0, 2000);
        fs::remove(folder_ / "hostile.json");
        EXPECT_EQ(contents(folder_.path()), all) << text.substr(0, 200);
    };
    const auto decision = [](const std::string& more) {
        return R"({ "aftershade": 1, "author": "ada@example.org", "decisions": [ { "decision": "approve", )" +
               more + " } ] }";
    };
    for (const char* name : {"../../etc/passwd", "/etc/passwd", "goldens/corner", ".", "", "nothing*"})
        refuses(decision("\"case\": \"" + std::string(name) + "\""), "matches no case's name or tag");
    refuses(decision(R"("case": "lends")"), "did you mean 'lens'?");
    refuses(decision(R"("case": "*", "images": [ { "name": "x", "test": "y" } ])"), "matches no case's name");
    refuses(decision(R"("case": "corner\u0000/x")"), "zero byte");
    refuses(decision(R"("case": "corner", "by": "\u001b[2J")"), "control character");
    refuses(decision("\"case\": \"" + std::string(100'000, 'x') + "\""), "the most is 200");
    refuses(std::string(100'000, '['), "nested deeper");
    refuses("{", "hostile.json");
    refuses(R"({ "aftershade": 1, "decisions": {} })", "decisions");
    fs::create_symlink("/etc/passwd", folder_ / "link.json");
    EXPECT_NE(apply({"link.json"}).exit_code, 0);
    EXPECT_NE(apply({"/dev/zero"}).exit_code, 0);
}

TEST_F(GoldenApply, WritesNothingThroughALinkInPlaceOfAGolden) {
    write_decisions(Json::array({{{"case", "corner"}, {"decision", "approve"}, {"by", "ada@example.org"}}}));
    const std::string victim = (folder_ / "victim").string();
    write_text(victim, "precious");
    fs::remove(image("corner.color.0001"));
    fs::create_symlink(victim, image("corner.color.0001"));
    EXPECT_NE(apply({"decisions.json"}).exit_code, 0);
    EXPECT_EQ(read_text(victim), "precious");
}

}  // namespace
}  // namespace aftershade::test
