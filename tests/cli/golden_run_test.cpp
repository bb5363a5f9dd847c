#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <thread>

#include "framework/file/png_file.h"
#include "framework/golden/approved_image.h"
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

// ---- planted faults ----

TEST_F(GoldenRun, CatchesOnePixel) {
    write_suite(R"("fail": 0.004)");
    approve();
    change_image(image("corner.color.0001"), [](Image& pixels) { pixels.at(31, 17, 1) += 0.01f; });
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(
        std::regex_search(result.err, std::regex(R"(FAILED corner: failure\n.*corner\.color\.0001: RGB: )")))
        << result.err;
    EXPECT_NE(result.err.find("1 passed"), std::string::npos) << "the other case is sound";
    const Json document = report();
    EXPECT_EQ(colors_of(case_of(document, "corner")["images"][0])["max_error"]["x"], 31);
}

TEST_F(GoldenRun, CatchesAHexagonTurnedByOneDegree) {
    approve();
    std::string turned = kLens;
    turned.replace(turned.find("\"rotation\": 0"), 13, "\"rotation\": 1");
    write_text(folder_ / "lens.json", turned);
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("FAILED lens"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("FAILED corner"), std::string::npos) << result.err;
}

TEST_F(GoldenRun, CatchesAChangedConstantOfAShader) {
    approve();
    const fs::path effect = folder_ / "mine/vignette";
    fs::create_directory(folder_ / "mine");
    fs::copy(fs::path(AFTERSHADE_SOURCE_DIR) / "effects/vignette", effect, fs::copy_options::recursive);
    const std::vector<std::string> with_copy = {"--effect-path", "mine"};
    EXPECT_EQ(run(with_copy).exit_code, 0) << "a copy is no change";
    std::string shader = read_text(effect / "vignette.frag");
    const std::string constant = "(3.0 - 2.0 * t)";
    ASSERT_NE(shader.find(constant), std::string::npos);
    shader.replace(shader.find(constant), constant.size(), "(3.0 - 2.2 * t)");
    write_text(effect / "vignette.frag", shader);
    const CommandResult result = run(with_copy);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("approve golden.json --filter corner --effect-path mine"), std::string::npos)
        << result.err;
}

TEST_F(GoldenRun, TellsAnEffectThatFailsAndGoesOn) {
    approve();
    fs::create_directory(folder_ / "mine");
    fs::copy(fs::path(AFTERSHADE_SOURCE_DIR) / "effects/vignette", folder_ / "mine/vignette",
             fs::copy_options::recursive);
    const fs::path shader = folder_ / "mine/vignette/vignette.frag";
    write_text(shader, read_text(shader) + "\nfloat broken() { return parm; }\n");
    const CommandResult result = run({"--effect-path", "mine"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(std::regex_search(result.err, std::regex(R"(vignette\.frag:\d+:.*parm)"))) << result.err;
    EXPECT_NE(result.err.find("1 passed"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("to approve"), std::string::npos) << "there is no image to approve";
}

TEST_F(GoldenRun, TellsAnotherMachineFromAChangedLookAndAChangedCapture) {
    approve();
    const auto says = [&](const std::string& text) {
        const CommandResult result = run();
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
        return case_of(report(), "corner")["images"][0];
    };
    const auto edit_sidecar = [&](const std::string& key, const std::string& value) {
        const fs::path file = folder_ / "goldens/corner.color.0001.json";
        Json sidecar = Json::parse(read_text(file));
        sidecar[key] = value;
        sidecar["image_hash"] = file_hash(image("corner.color.0001"));
        write_text(file, sidecar.dump());
    };
    change_image(image("corner.color.0001"), [](Image& pixels) { pixels.floats()[0] += 1; });
    edit_sidecar("version", "4.5 (Core Profile) Mesa 9.2.1");
    Json seen = says("corner.color.0001: only the machine differs: Mesa ");
    EXPECT_EQ(seen["only_machine_changed"], true);
    EXPECT_NE(run().err.find("to keep this machine's image too: aftershade golden approve golden.json "
                             "--filter corner --add"),
              std::string::npos);
    edit_sidecar("look_hash", "0123456789abcdef");
    seen = says("corner.color.0001: the look or an effect has changed since it was approved");
    EXPECT_EQ(seen["only_machine_changed"], false);
    EXPECT_EQ(seen["changes"].size(), 2u) << seen["changes"];
    edit_sidecar("look_hash", case_of(report(), "corner")["look_hash"]);
    edit_sidecar("version", report()["environment"]["version"]);
    write_frame(1, 29);
    seen = says("corner.color.0001: the capture has changed since it was approved");
    EXPECT_EQ(seen["changes"].size(), 1u) << seen["changes"];
}

TEST_F(GoldenRun, CountsWhatPassesByItsToleranceAlone) {
    approve();
    change_image(image("corner.color.0001"), [](Image& pixels) { pixels.floats()[0] += 0.001f; });
    const fs::path file = folder_ / "goldens/corner.color.0001.json";
    Json sidecar = Json::parse(read_text(file));
    sidecar["version"] = "4.5 (Core Profile) Mesa 9.2.1";
    sidecar["image_hash"] = file_hash(image("corner.color.0001"));
    write_text(file, sidecar.dump());
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(
        result.err.find("1 image within tolerance, but with other bits: only the machine differs: Mesa "),
        std::string::npos)
        << result.err;
}

TEST_F(GoldenRun, WarnsOfAnyBitWhereNothingThatChangesBitsHasChanged) {
    write_suite(R"("fail": 100)");
    approve();
    change_image(image("corner.color.0001"), [](Image& pixels) { pixels.floats()[0] += 1; });
    const fs::path file = folder_ / "goldens/corner.color.0001.json";
    Json sidecar = Json::parse(read_text(file));
    sidecar["image_hash"] = file_hash(image("corner.color.0001"));
    write_text(file, sidecar.dump());
    EXPECT_NE(run({"--filter", "corner"}).err.find("bits differ although"), std::string::npos);
    approve();
    write_frame(1, 30.1f);  // of the pictures, but of neither look nor renderer
    const CommandResult result = run({"--filter", "corner"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("WARNING corner"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("the capture has changed since it was approved"), std::string::npos)
        << result.err;
    EXPECT_EQ(run({"--filter", "corner"}, {{"GALLIUM_OVERRIDE_CPU_CAPS", "sse2"}}).exit_code, 0)
        << "another machine has the tolerance";
}

TEST_F(GoldenRun, HoldsAGoldenThatWasCopiedByHandToItsToleranceAlone) {
    write_suite(R"("fail": 0.5)");
    EXPECT_EQ(run({"--report", "report"}).exit_code, 2) << "there is no golden yet";
    fs::create_directory(folder_ / "goldens");
    const Json first = Json::parse(read_text(folder_ / "report/report.json"));
    for (const Json& test : first["cases"])
        for (const Json& made : test["images"])
            fs::copy_file(folder_ / "report" / made["pictures"]["test_exr"].get<std::string>(),
                          image(made["name"].get<std::string>()));
    const Json copied = report();
    EXPECT_EQ(copied["exit_code"], 0);
    EXPECT_TRUE(all_bits_equal(copied));
    for (const Json& test : copied["cases"])
        for (const Json& made : test["images"]) {
            EXPECT_EQ(made["tier"], "tolerance") << "nothing tells what made the golden";
            EXPECT_TRUE(made["approved"]["sidecar"].is_null());
        }
    const CommandResult told = run();
    EXPECT_EQ(told.exit_code, 0) << "an image without a sidecar is no orphan; " << told.err;
    EXPECT_NE(told.err.find("note: goldens/lens.color.0001.exr and 2 more goldens: no sidecar records what "
                            "made them, so only the tolerance counts"),
              std::string::npos)
        << told.err;
    write_frame(1, 30.1f);
    EXPECT_EQ(run({"--filter", "corner"}).exit_code, 0) << "other bits are no warning";
    write_frame(1, 40);
    EXPECT_EQ(run({"--filter", "corner"}).exit_code, 2);
    write_frame(1, 30);
    // A golden copied over an approved one: the sidecar that stays is of another image.
    approve({"--renew-sidecars"});
    EXPECT_EQ(case_of(report(), "corner")["images"][0]["tier"], "bits");
    EXPECT_EQ(run().err.find("note:"), std::string::npos);
    change_image(image("corner.color.0001"), [](Image& pixels) { pixels.at(31, 17, 1) += 0.01f; });
    EXPECT_EQ(case_of(report(), "corner")["images"][0]["tier"], "tolerance");
    const CommandResult over = run();
    EXPECT_EQ(over.exit_code, 1) << over.err;
    EXPECT_NE(over.err.find("goldens/corner.color.0001.json: is of another image than "
                            "corner.color.0001.exr (golden approve writes it again)"),
              std::string::npos)
        << over.err;
}

TEST_F(GoldenRun, EndsWithTheWorstVerdict) {
    approve();
    fs::copy_file(image("corner.color.0001"), image("keep"));
    change_image(image("corner.color.0001"), [](Image& pixels) { pixels = Image(8, 8, 4); });
    fs::remove(image("keep"));
    EXPECT_EQ(run().exit_code, 3);
    fs::resize_file(image("lens.color.0001"), 200);
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("file error"), std::string::npos) << result.err;
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

// ---- reports ----

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
