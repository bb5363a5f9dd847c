// What reports of golden suites say: each reason once, with size and place, of this run and no other.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class GoldenMessages : public GoldenCommand {
protected:
    /// Runs with both reports.
    CommandResult reported(std::vector<std::string> words = {}, const Environment& environment = {}) {
        words.insert(words.end(), {"--junit", "j.xml", "--report", "report"});
        return run(words, environment);
    }
    std::string junit() const { return read_text(folder_ / "j.xml"); }
    static std::size_t count(const std::string& text, const std::string& word) {
        std::size_t found = 0;
        for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++found;
        return found;
    }
};

TEST_F(GoldenMessages, OfAFailureHaveSizeAndPlaceAndWhatIsAllowed) {
    write_suite(R"("fail": 0.004, "allow_failures": 1)");
    approve();
    change_image(image("corner.color.0001"), [](Image& pixels) {
        for (int x = 10; x < 13; ++x) pixels.at(x, 5, 1) += 0.125f;
        pixels.at(31, 17, 2) += 0.5f;
    });
    const CommandResult result = reported();
    EXPECT_EQ(result.exit_code, 2);
    for (const std::string& text : {result.err, junit()}) {
        EXPECT_NE(text.find("differ by more than fail 0.004, 1 allowed"), text.npos) << text;
        EXPECT_TRUE(std::regex_search(text, std::regex(R"(largest difference 0\.\d+ at \(31, 17\) B, )")))
            << text;
    }
    EXPECT_EQ(result.err.find(" may"), result.err.npos) << result.err;
}

TEST_F(GoldenMessages, OfAQuarantineHaveItsDayAndItsReason) {
    for (const auto& [until, code, word] :
         {std::tuple{"2199-12-31", 1, "until"}, {"2020-02-29", 2, "ended"}}) {
        write_text(folder_ / "golden.json",
                   R"({ "aftershade": 1, "cases": [ { "name": "corner", "steps": [ { "effect": "vignette" } ],
            "capture": "in_0001.exr", "quarantine": { "until": ")" +
                       std::string(until) + R"(", "reason": "driver 22.3 rounds otherwise" } } ] })");
        approve();
        const CommandResult passing = run();
        EXPECT_EQ(passing.exit_code, 0);
        EXPECT_NE(passing.err.find("note: corner passes; it needs no quarantine"), passing.err.npos)
            << passing.err;
        change_image(image("corner.color.0001"), [](Image& pixels) { pixels.at(31, 17, 2) += 0.5f; });
        const CommandResult result = reported();
        EXPECT_EQ(result.exit_code, code) << result.err;
        const std::string line =
            std::string("quarantine ") + word + " " + until + ": driver 22.3 rounds otherwise";
        EXPECT_NE(result.err.find(line), result.err.npos) << result.err;
        EXPECT_NE(junit().find(line), std::string::npos);
    }
    for (const std::string until : {"2027-02-30", "2027-01- 1", "-027-01-31", "2027-1-31", "31.01.2027"}) {
        write_text(folder_ / "golden.json",
                   R"({ "aftershade": 1, "cases": [ { "name": "corner", "steps": [ { "effect": "vignette" } ],
            "capture": "in_0001.exr", "quarantine": { "until": ")" +
                       until + R"(" } } ] })");
        const CommandResult faulty = run();
        EXPECT_EQ(faulty.exit_code, 64);
        EXPECT_NE(faulty.err.find("'" + until + "' is not a day such as 2027-01-31"), faulty.err.npos)
            << faulty.err;
        EXPECT_NE(faulty.err.find("the quarantine has no 'reason'"), faulty.err.npos) << faulty.err;
    }
}

TEST_F(GoldenMessages, TellAReasonOfSeveralImagesOnce) {
    approve();
    write_text(folder_ / "lens.json",
               std::regex_replace(std::string(kLens), std::regex("hexagon"), "square"));
    const CommandResult result = run();
    EXPECT_EQ(count(result.err, "the look or an effect has changed since it was approved"), 1u) << result.err;
    EXPECT_NE(result.err.find("lens.color.0001, lens.color.0002: the look"), result.err.npos) << result.err;
}

TEST_F(GoldenMessages, OfAPointerOfGitLfsNameTheRemedyAlone) {
    approve();
    const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 9\n";
    write_text(image("corner.color.0001"), pointer);
    const CommandResult kept = golden({"approve", "golden.json"});
    EXPECT_EQ(kept.exit_code, 4) << "no one has seen what the new image would replace\n" << kept.err;
    EXPECT_NE(kept.err.find("git lfs pull"), kept.err.npos) << kept.err;
    EXPECT_EQ(read_text(image("corner.color.0001")), pointer);
    const CommandResult result = reported();
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_NE(result.err.find("git lfs pull"), result.err.npos) << result.err;
    EXPECT_EQ(result.err.find("approve"), result.err.npos) << result.err;
    EXPECT_NE(junit().find("failures=\"0\" errors=\"1\""), std::string::npos) << junit();
}

TEST_F(GoldenMessages, OfDocumentsThatGitLfsHasNotFetchedNameTheRemedy) {
    approve();
    const std::filesystem::path sidecar = sidecar_path(image("corner.color.0001"));
    for (const std::filesystem::path& file : {folder_ / "lens.json", sidecar, folder_ / "golden.json"}) {
        SCOPED_TRACE(file);
        const std::string text = read_text(file);
        write_text(file, "version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 9\n");
        const CommandResult result = run();
        EXPECT_GE(result.exit_code, 2);
        EXPECT_NE(result.err.find(file.filename().string() + ": "), result.err.npos) << result.err;
        EXPECT_NE(result.err.find("is a pointer of Git LFS, not the file itself (fetch it: git lfs pull)"),
                  result.err.npos)
            << result.err;
        EXPECT_EQ(result.err.find("syntax error"), result.err.npos) << result.err;
        write_text(file, text);
    }
}

TEST_F(GoldenMessages, HaveTheErrorsOfAShaderInTheSnippet) {
    fs::create_directories(folder_ / "effects/bad");
    write_text(folder_ / "effects/bad/effect.json",
               R"({ "aftershade": 1, "id": "bad", "version": "1.0.0", "summary": "Bad.",
        "inputs": { "color": { "role": "color", "doc": "Light." } }, "outputs": { "color": { "role": "color", "doc": "Light." } },
        "passes": [ { "name": "p", "shader": "p.frag", "reads": [{ "color": "pixel" }], "writes": ["color"] } ] })");
    write_text(folder_ / "effects/bad/p.frag",
               "#version 450 core\n#include <pass>\nvoid main() { out_color = vec4(no_such_name); }\n");
    write_suite(R"("fail": 0.004)",
                R"(, { "name": "bad", "steps": [ { "effect": "bad" } ], "capture": "in_0001.exr" })");
    reported({"--filter", "bad", "--effect-path", "effects"});
    const std::string text = junit();
    const std::size_t message = text.find("message=\"");
    EXPECT_NE(text.substr(message, text.find("\">", message) - message).find("no_such_name"), text.npos)
        << text;
}

TEST_F(GoldenMessages, NameSidecarsAndImagesOfCasesThatAreNoMore) {
    approve();
    write_text(
        folder_ / "golden.json",
        R"({ "aftershade": 1, "cases": [ { "name": "other", "steps": [], "capture": "in_0001.exr" } ] })");
    fs::remove(image("corner.color.0001"));
    const CommandResult result = run();
    EXPECT_NE(
        result.err.find("corner.color.0001.json: no case gives this golden: a sidecar without an image"),
        result.err.npos)
        << result.err;
    EXPECT_NE(result.err.find("lens.color.0001.exr: no case gives this golden; remove it"), result.err.npos)
        << result.err;
}

TEST_F(GoldenMessages, NameWhatNoLimitHolds) {
    write_suite(R"("fail": 1000000, "fail_flip": 0.05)");
    approve();
    change_image(image("corner.color.0001"), [](Image& pixels) { pixels.at(3, 3, 3) = 0; });
    fs::remove(folder_ / "goldens/corner.color.0001.json");  // which is of the image as it was
    const CommandResult result = reported();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("(not judged: A)"), result.err.npos) << result.err;
    EXPECT_NE(junit().find("<system-out>not judged: A</system-out>"), std::string::npos) << junit();
    EXPECT_EQ(case_of(Json::parse(read_text(folder_ / "report/report.json")), "corner")["allowances"],
              "not judged: A");
}

TEST_F(GoldenMessages, OfAnEarlierRunDoNotStayWhereOneEndsEarly) {
    approve();
    const auto expect_early = [&](const CommandResult& result, int code, const std::string& word) {
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_NE(junit().find("failures=\"0\" errors=\"1\""), std::string::npos) << junit();
        EXPECT_NE(junit().find(word), std::string::npos) << junit();
        const Json json = Json::parse(read_text(folder_ / "report/report.json"));
        EXPECT_EQ(json["exit_code"], code);
        EXPECT_NE(json["error"].get<std::string>().find(word), std::string::npos);
        EXPECT_TRUE(json["cases"].empty());
        EXPECT_NE(read_text(folder_ / "report/index.html").find(word), std::string::npos);
    };
    const auto pass = [&] {
        EXPECT_EQ(reported().exit_code, 0);
        EXPECT_NE(junit().find("errors=\"0\""), std::string::npos);
    };
    pass();
    expect_early(reported({}, without_gl(folder_ / "no_gl")), 4, "no usable GL");
    pass();
    expect_early(reported({"--filter", "lnes"}), 64, "lnes");
    pass();
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "cases": [ { "name": "c", "stepz": [] } ] })");
    expect_early(reported(), 64, "stepz");
}

TEST_F(GoldenMessages, OfAnEarlyEndMayLieInTheFolderOfTheReport) {
    EXPECT_EQ(run({"--filter", "lnes", "--report", "fresh", "--junit", "fresh/junit.xml"}).exit_code, 64);
    EXPECT_NE(read_text(folder_ / "fresh/junit.xml").find("errors=\"1\""), std::string::npos);
}

TEST_F(GoldenMessages, OfAnEarlyEndReplaceNoOtherFile) {
    write_text(folder_ / "golden.json", "{ \"aftershade\": 1, \"cases\": [ 1 ] }");
    const std::string suite = read_text(folder_ / "golden.json");
    EXPECT_EQ(run({"--junit", "golden.json"}).exit_code, 64);
    EXPECT_EQ(read_text(folder_ / "golden.json"), suite);
    fs::create_directories(folder_ / "site");
    write_text(folder_ / "site/report.json", "{ \"mine\": 1 }");
    EXPECT_EQ(run({"--report", "site"}).exit_code, 64);
    EXPECT_EQ(read_text(folder_ / "site/report.json"), "{ \"mine\": 1 }");
}

TEST_F(GoldenMessages, OfAGoldensNameIsOneLine) {
    approve();
    for (const char* name :
         {"corner.color.0001@x\nFAILED forged: all is lost", "stray\nFAILED forged: all is lost"}) {
        const std::filesystem::path file = image(name);
        std::filesystem::copy(image("corner.color.0001"), file);
        const CommandResult result = run();
        EXPECT_NE(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err.find("\nFAILED forged"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("?FAILED forged"), std::string::npos) << result.err;
        std::filesystem::remove(file);
    }
}

}  // namespace
}  // namespace aftershade::test
