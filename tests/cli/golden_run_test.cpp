#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "framework/file/png_file.h"
#include "tests/backends.h"
#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

using GoldenRun = GoldenCommand;

TEST_F(GoldenRun, PassesByItsGoldensAndTellsItAsCtestDoes) {
    approve();
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "") << "people read stderr";
    EXPECT_TRUE(std::regex_search(result.err, std::regex(R"(2/2 \w+ \.+ +Passed +\d+\.\d\d s)")))
        << result.err;
    EXPECT_NE(result.err.find("2 passed, 0 with warnings, 0 failed, 0 skipped, 2 cases"), std::string::npos)
        << result.err;
}

TEST_F(GoldenRun, FailsWithoutGoldensAndNamesTheCommandThatApproves) {
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("lens.color.0002: no golden goldens/lens.color.0002.exr"), std::string::npos)
        << result.err;
    const std::string command = "to approve: aftershade golden approve golden.json --filter lens\n";
    EXPECT_NE(result.err.find(command), std::string::npos) << result.err;
    EXPECT_EQ(golden({"approve", "golden.json", "--filter", "lens"}).exit_code, 0);
    const CommandResult again = run();
    EXPECT_EQ(again.exit_code, 2) << "of the other case";
    EXPECT_NE(again.err.find("1 passed, 0 with warnings, 1 failed"), std::string::npos) << again.err;
}

TEST_F(GoldenRun, NamesASuiteThatBeginsWithADashAsAPathInItsCommands) {
    std::filesystem::create_directories(folder_ / "-suite");
    std::string document = read_text(folder_ / "golden.json");
    for (const char* name : {"lens.json", "in_"})
        for (std::size_t at = 0; (at = document.find(name, at)) != document.npos; at += 4)
            document.insert(at, "../");
    write_text(folder_ / "-suite/golden.json", document);
    const CommandResult result = golden({"run", "--", "-suite"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("to approve: aftershade golden approve ./-suite --filter lens\n"),
              std::string::npos)
        << result.err;
}

TEST_F(GoldenRun, FailsTheCaseAloneWhoseGoldenLeadsOutOfItsFolder) {
    approve();
    const TemporaryFolder elsewhere;
    std::filesystem::rename(image("corner.color.0001"), elsewhere / "corner.exr");
    std::filesystem::create_symlink(elsewhere / "corner.exr", image("corner.color.0001"));
    const Json told = report();
    EXPECT_EQ(told["exit_code"], 4);
    EXPECT_EQ(case_of(told, "lens")["verdict"], "same");
    EXPECT_NE(case_of(told, "corner")["messages"].dump().find("leads out of the folder"), std::string::npos);
    write_frame(1, 90);
    const CommandResult approved = golden({"approve", "golden.json"});
    EXPECT_EQ(approved.exit_code, 4) << approved.err;
    EXPECT_NE(approved.out.find("lens.color.0001.exr"), std::string::npos) << "the other case is approved";
    EXPECT_TRUE(std::filesystem::is_symlink(image("corner.color.0001")));
    EXPECT_EQ(golden({"explain", "golden.json", "corner"}).exit_code, 1);
}

TEST_F(GoldenRun, FailsForOrphanedGoldens) {
    approve();
    fs::copy_file(image("lens.color.0001"), image("lens.color.0007"));
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("FAILED goldens/lens.color.0007.exr: no case gives this golden"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(run({"--filter", "corner"}).exit_code, 0) << "of another case";
}

TEST_F(GoldenRun, SkipsWithAReasonAndFailsForItWhenAsked) {
    approve();
    write_suite(R"("fail": 0.004)", R"(,
    { "name": "later", "steps": [], "capture": "in_0001.exr", "skip": "waits for its capture" },
    { "name": "absent", "steps": [], "capture": "large/capture.json", "optional": true })");
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("***Skipped"), std::string::npos);
    EXPECT_NE(result.err.find("(waits for its capture)"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("(no capture large/capture.json)"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("2 skipped"), std::string::npos);
    EXPECT_EQ(run({"--no-skip"}).exit_code, 2);
}

TEST_F(GoldenRun, WarnsWhereEveryCaseWasSkippedAndNothingCompared) {
    approve();
    write_suite(R"("fail": 0.004)", R"(,
    { "name": "later", "steps": [], "capture": "in_0001.exr", "skip": "waits for its capture" },
    { "name": "absent", "steps": [], "capture": "large/capture.json", "optional": true })");
    const std::vector<std::string> skipped = {"--filter", "later", "--filter", "absent"};
    const CommandResult result = run(skipped);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("every case was skipped; nothing was compared"), std::string::npos)
        << result.err;
    const Json document = report(skipped);
    EXPECT_EQ(document["verdict"], "warning");
    EXPECT_EQ(document["exit_code"], 1);
    EXPECT_EQ(run({"--no-skip", "--filter", "later"}).exit_code, 2);
    const CommandResult one_ran = run({"--filter", "later", "--filter", "corner"});
    EXPECT_EQ(one_ran.exit_code, 0) << one_ran.err;
    EXPECT_EQ(one_ran.err.find("nothing was compared"), std::string::npos) << one_ran.err;
}

TEST_F(GoldenRun, EndsACaseThatTakesTooLong) {
    std::string steps;
    for (int i = 0; i < 40; ++i)
        steps += std::string(i == 0 ? "" : ", ") + R"({ "effect": "bokeh", "name": "b)" + std::to_string(i) +
                 "\" }";
    write_text(folder_ / "slow.json", R"({ "aftershade": 1, "steps": [ )" + steps + " ] }");
    write_suite(R"("fail": 0.004)", R"(,
    { "name": "long", "look": "slow.json", "capture": "in_0001.exr" })");
    const CommandResult result = run({"--timeout", "0.1", "--filter", "long"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("0.1 s"), std::string::npos) << result.err;
}

TEST_F(GoldenRun, EndsWith64ForWrongWordsAndDocuments) {
    EXPECT_EQ(golden({}).exit_code, 64);
    EXPECT_EQ(golden({"run"}).exit_code, 64);
    EXPECT_EQ(golden({"run", "nowhere.json"}).exit_code, 64);
    EXPECT_EQ(run({"--fliter", "x"}).exit_code, 64);
    EXPECT_EQ(run({"--backend", "vulkan"}).exit_code, 64);
    const CommandResult filter = run({"--filter", "slwo"});
    EXPECT_EQ(filter.exit_code, 64);
    EXPECT_NE(filter.err.find("did you mean 'slow'"), std::string::npos) << filter.err;
    const CommandResult filters = run({"--filter", "lens", "--filter", "lends", "--filter", "x/*"});
    EXPECT_EQ(filters.exit_code, 64) << "although one fits";
    EXPECT_NE(filters.err.find("--filter lends: error: matches no case's name or tag; did you mean 'lens'"),
              std::string::npos)
        << filters.err;
    EXPECT_NE(filters.err.find("--filter x/*: error: matches no case"), std::string::npos) << filters.err;
    EXPECT_EQ(golden({"approve", "golden.json", "--filter", "lends"}).exit_code, 64);
    write_suite(R"("fial": 0.004)");
    const CommandResult document = run();
    EXPECT_EQ(document.exit_code, 64);
    EXPECT_NE(
        document.err.find("golden.json:3:21: error: the tolerance has no key 'fial'; did you mean 'fail'"),
        std::string::npos)
        << document.err;
    EXPECT_NE(document.err.find("golden.json:5:21: error: "), std::string::npos) << "all at once\n"
                                                                                 << document.err;
}

TEST_F(GoldenRun, NeedsGl) {
    const CommandResult result = run({}, without_gl(folder_ / "no_gl"));
    EXPECT_EQ(result.exit_code, 4) << result.err;
    for (const char* backend : {"egl-software: ", "osmesa: "})
        EXPECT_NE(result.err.find(backend), std::string::npos) << result.err;
}

TEST_F(GoldenRun, TakesTheSoftwareBackendThatIsThereAsOneRenderer) {
    SKIP_WITHOUT(gpu::Backend::egl_software);
    SKIP_WITHOUT(gpu::Backend::osmesa);
    approve();
    for (const char* hidden : {"libOSMesa", "libEGL"}) {
        const CommandResult result = run({"--json"}, without_gl(folder_ / hidden, {hidden}));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err.find("install"), std::string::npos) << result.err;
        EXPECT_EQ(Json::parse(result.out).at("environment").at("backend").get<std::string>(), "software");
    }
}

TEST_F(GoldenRun, HasAnImageForEachOutputTapAndFrame) {
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "goldens": "kept", "cases": [
    { "name": "all", "look": "lens.json", "capture": "in_####.exr", "outputs": ["color", "depth"],
      "taps": ["bokeh.surroundings"], "set": ["bokeh.f_number=0.8", "bokeh.highlight_gain=1"] } ] })");
    approve();
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "kept"))
        if (entry.path().extension() == ".exr") names.insert(entry.path().stem().string());
    EXPECT_EQ(names, (std::set<std::string>{"all.bokeh.surroundings.0001", "all.bokeh.surroundings.0002",
                                            "all.color.0001", "all.color.0002", "all.depth.0001",
                                            "all.depth.0002"}));
    const ExrFile depth(folder_ / "kept/all.depth.0001.exr");
    ASSERT_EQ(depth.parts()[0].channels.size(), 1u);
    EXPECT_EQ(depth.parts()[0].channels[0].name, "Z");
    EXPECT_TRUE(all_bits_equal(report()));
    EXPECT_EQ(run({}).exit_code, 0);
    fs::remove(folder_ / "kept/all.bokeh.surroundings.0002.exr");
    EXPECT_EQ(run({}).exit_code, 2);
}

TEST_F(GoldenRun, TakesTheCasesOfEffectsInAFolder) {
    fs::create_directories(folder_ / "own/effects");
    fs::copy(fs::path(AFTERSHADE_SOURCE_DIR) / "effects/vignette", folder_ / "own/effects/tone_edge",
             fs::copy_options::recursive);
    fs::remove_all(folder_ / "own/effects/tone_edge/cases");
    fs::create_directory(folder_ / "own/effects/tone_edge/cases");
    std::string manifest = read_text(folder_ / "own/effects/tone_edge/effect.json");
    manifest.replace(manifest.find("\"vignette\""), 10, "\"tone_edge\"");
    write_text(folder_ / "own/effects/tone_edge/effect.json", manifest);
    write_text(
        folder_ / "own/effects/tone_edge/cases/plain.json",
        R"({ "aftershade": 1, "capture": "../in_0001.exr", "frames": "1", "steps": [ { "effect": "tone_edge" } ],
                    "outputs": ["color"], "tolerance": { "fail": 0.004, "fail_percent": 0, "hard_fail": 0.004 } })");
    write_text(folder_ / "golden.json",
               R"({ "aftershade": 1, "effect_paths": ["own/effects"], "cases_of_effects": true })");
    approve();
    EXPECT_TRUE(fs::exists(folder_ / "own/effects/tone_edge/cases/plain.color.0001.exr"));
    const Json document = report();
    ASSERT_EQ(document["cases"].size(), 1u);
    EXPECT_EQ(document["cases"][0]["name"], "tone_edge/plain");
    EXPECT_EQ(document["exit_code"], 0);
}

TEST_F(GoldenRun, CountsNoCaseAsPassedThatAnInterruptKeptFromRunning) {
    Command command(aftershade_words({"golden", "run", "golden.json", "-j", "1", "--junit", "out.xml"}),
                    folder_.path());
    ASSERT_TRUE(command.wait_until_it_handles(SIGINT));
    command.send(SIGINT);
    const CommandResult result = command.wait();
    ASSERT_EQ(result.exit_code, 130) << result.err;
    EXPECT_NE(result.err.find("0 passed"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("interrupted\n"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "out.xml")) << "half a report says less than none";
}

TEST_F(GoldenRun, WritesJUnitThatAParserOfXmlTakes) {
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "cases": [
    { "name": "corner", "steps": [ { "effect": "vignette" } ], "capture": "in_0001.exr" },
    { "name": "lens", "look": "lens.json", "capture": "in_0001.exr", "set": ["bokeh.shape=\"<&'\u0001>\""] },
    { "name": "later", "steps": [], "capture": "in_0001.exr", "skip": "<&\">" } ] })");
    EXPECT_EQ(run({"--junit", "out.xml"}).exit_code, 2);
    write_text(folder_ / "read.py", R"(
import sys, xml.etree.ElementTree as tree
root = tree.parse("out.xml").getroot()
suite = root.find("testsuite")
print(root.tag, *sorted(root.keys()))
for key in ("tests", "failures", "skipped"): print(key, suite.get(key))
for case in suite.findall("testcase"):
    print(case.get("name"), [(child.tag, child.get("message")[:12]) for child in case])
)");
    const CommandResult parsed = Command({"/usr/bin/python3", "read.py"}, folder_.path()).wait();
    ASSERT_EQ(parsed.exit_code, 0) << parsed.err << read_text(folder_ / "out.xml");
    EXPECT_EQ(parsed.out.substr(0, parsed.out.find("lens")),
              "testsuites errors failures tests time\ntests 3\nfailures 2\nskipped 1\ncorner [('failure', "
              "'corner.color')]\n");
    EXPECT_NE(parsed.out.find("later [('skipped', '<&\">')]"), std::string::npos) << parsed.out;
}

TEST_F(GoldenRun, ReportsEverythingThatAPageNeeds) {
    approve();
    change_image(image("corner.color.0001"), [](Image& pixels) { pixels.at(31, 17, 1) += 0.5f; });
    EXPECT_EQ(run({"--report", "report", "--json"}).exit_code, 2);
    const Json document = Json::parse(read_text(folder_ / "report/report.json"));
    EXPECT_EQ(document["verdict"], "failure");
    EXPECT_EQ(document["counts"]["failed"], 1);
    EXPECT_EQ(document["approve"], "aftershade golden approve golden.json --filter corner");
    for (const char* key : {"backend", "renderer", "version", "mesa", "llvm", "cpu", "key", "aftershade"})
        EXPECT_TRUE(document["environment"][key].is_string()) << key;
    const Json& failed = case_of(document, "corner");
    EXPECT_EQ(failed["approve"], document["approve"]);
    EXPECT_NE(failed["command"].get<std::string>().find("aftershade run "), std::string::npos);
    const Json& image = failed["images"][0];
    EXPECT_EQ(colors_of(image)["failing"]["pixels"], 1);
    const auto picture = [&](const char* key) {
        return read_png(folder_ / "report" / image["pictures"][key].get<std::string>());
    };
    for (const char* key : {"reference", "test"})
        EXPECT_EQ(picture(key).width(), 5 * 64) << "enlarged to be seen";
    for (const char* key : {"difference", "heat_map"}) EXPECT_EQ(picture(key).width(), 64) << key;
    EXPECT_EQ(picture("difference").at(31, 17, 1), 1);
    EXPECT_EQ(picture("difference").at(31, 17, 0), 0);
    EXPECT_EQ(picture("difference").at(30, 17, 1), 0);
    for (const char* key : {"reference_exr", "test_exr", "side_by_side"})
        EXPECT_TRUE(fs::exists(folder_ / "report" / image["pictures"][key].get<std::string>())) << key;
    const Json& passed = case_of(document, "lens")["images"][0];
    EXPECT_EQ(passed["bits_equal"], true);
    EXPECT_TRUE(passed["pictures"]["test"].is_string());
    EXPECT_TRUE(passed["pictures"]["heat_map"].is_null()) << "there is no difference to be seen";
}

}  // namespace
}  // namespace aftershade::test
