// What makes a case fail or warn, by planted faults.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "framework/golden/approved_image.h"
#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

using GoldenVerdicts = GoldenCommand;

TEST_F(GoldenVerdicts, CatchesOnePixel) {
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

TEST_F(GoldenVerdicts, CatchesAHexagonTurnedByOneDegree) {
    approve();
    std::string turned = kLens;
    turned.replace(turned.find("\"rotation\": 0"), 13, "\"rotation\": 1");
    write_text(folder_ / "lens.json", turned);
    const CommandResult result = run();
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("FAILED lens"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("FAILED corner"), std::string::npos) << result.err;
}

TEST_F(GoldenVerdicts, CatchesAChangedConstantOfAShader) {
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

TEST_F(GoldenVerdicts, TellsAnEffectThatFailsAndGoesOn) {
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

TEST_F(GoldenVerdicts, TellsAnotherMachineFromAChangedLookAndAChangedCapture) {
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

TEST_F(GoldenVerdicts, CountsWhatPassesByItsToleranceAlone) {
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

TEST_F(GoldenVerdicts, WarnsOfAnyBitWhereNothingThatChangesBitsHasChanged) {
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

TEST_F(GoldenVerdicts, HoldsAGoldenThatWasCopiedByHandToItsToleranceAlone) {
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

TEST_F(GoldenVerdicts, EndsWithTheWorstVerdict) {
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

}  // namespace
}  // namespace aftershade::test
