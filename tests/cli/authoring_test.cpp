// list, describe, new, check and docs.
#include <gtest/gtest.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "framework/capture/cryptomatte.h"
#include "tests/capture/capture_files.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Authoring : public testing::Test {
protected:
    CommandResult command(std::vector<std::string> arguments, int exit_code = 0) {
        CommandResult result = run_aftershade(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
        return result;
    }
    void replace(const std::string& file, const std::string& before, const std::string& after) {
        std::string text = read_text(folder_ / file);
        const std::size_t at = text.find(before);
        ASSERT_NE(at, std::string::npos) << before;
        write_text(folder_ / file, text.replace(at, before.size(), after));
    }
    TemporaryFolder folder_;
};

TEST_F(Authoring, NewMakesAnEffectThatRunsAtOnceAndPassesItsCheck) {
    const CommandResult made = command({"new", "vignette2"});
    write_capture(make_capture({.width = 64, .height = 36, .background = {0.5f, 0.5f, 0.5f}}),
                  folder_ / "in_0001.exr");
    command({"run", "vignette2/look.json", "in_0001.exr", "--effect-path", ".", "-o", "out.exr", "--backend",
             "software"});
    const std::vector<std::string> channels{"R"};
    const Image out = ExrFile(folder_ / "out.exr").read_floats(0, channels);
    EXPECT_NEAR(out.at(32, 18, 0), 0.5f, 1e-3f);
    EXPECT_LT(out.at(0, 0, 0), 0.12f);
    const CommandResult checked = command({"check", "vignette2", "--strict", "--backend", "software"});
    EXPECT_EQ(checked.out, "vignette2: 0 errors, 0 warnings\n");
    EXPECT_NE(made.out.find("aftershade run ./vignette2/look.json CAPTURE --effect-path . -o out.png"),
              std::string::npos);
}

TEST_F(Authoring, NewPrintsCommandsThatAShellTakesWhateverTheFoldersName) {
    write_capture(make_capture({.width = 8, .height = 8}), folder_ / "in_0001.exr");
    const CommandResult made = command({"new", "mine", "--path", "it's $HOME"});
    std::smatch run, check;
    ASSERT_TRUE(std::regex_search(made.out, run, std::regex("Run it: +aftershade (.*) CAPTURE (.*)\n")));
    ASSERT_TRUE(std::regex_search(made.out, check, std::regex("Check it: aftershade (.*)\n")));
    const auto in_shell = [&](const std::string& words) {
        Command shell({"/bin/sh", "-c", "exec '" AFTERSHADE_EXECUTABLE "' " + words + " --backend software"},
                      folder_.path());
        const CommandResult result = shell.wait();
        EXPECT_EQ(result.exit_code, 0) << words << "\n" << result.err;
    };
    in_shell(run[1].str() + " in_0001.exr " + run[2].str());
    EXPECT_TRUE(fs::exists(folder_ / "out.png"));
    in_shell(check[1].str());
}

TEST_F(Authoring, TheDocsSayHowManyFilesAndLinesNewMakes) {
    command({"new", "vignette2"});
    int files = 0, lines = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "vignette2")) {
        ++files;
        lines += int(lines_of_text(read_text(entry.path())).size());
    }
    const std::string docs = read_text(fs::path(AFTERSHADE_SOURCE_DIR) / "docs/authoring.md");
    EXPECT_NE(docs.find(std::to_string(files) + " files, " + std::to_string(lines) + " lines"),
              std::string::npos)
        << files << " files, " << lines << " lines";
}

TEST_F(Authoring, WatchMakesThePictureAnewAtEverySaveAndWaitsFaultsOut) {
    command({"new", "mine"});
    write_capture(make_capture({.width = 480, .height = 270, .background = {0.5f, 0.5f, 0.5f}}),
                  folder_ / "in_0001.exr");
    Command watch({AFTERSHADE_EXECUTABLE, "run", "mine/look.json", "in_0001.exr", "--effect-path", ".", "-o",
                   "out.png", "--backend", "software", "--watch"},
                  folder_.path());
    ASSERT_TRUE(watch.wait_for_lines(1));
    const std::string first = read_text(folder_ / "out.png");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    replace("mine/look.json", "0.8", "0.2");
    ASSERT_TRUE(watch.wait_for_lines(2));
    const std::string second = read_text(folder_ / "out.png");
    EXPECT_NE(first, second) << "the look's value";
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    replace("mine/mine.frag", "1.0 - darkness", "1.0 - drakness");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    replace("mine/mine.frag", "1.0 - drakness", "1.0 - 2.0 * darkness");
    ASSERT_TRUE(watch.wait_for_lines(3));
    EXPECT_NE(read_text(folder_ / "out.png"), second) << "the shader";
    watch.send(SIGINT);
    const CommandResult result = watch.wait();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_NE(result.err.find("drakness"), std::string::npos) << "the fault was told\n" << result.err;
    std::smatch taken;
    ASSERT_TRUE(std::regex_search(result.err, taken, std::regex("re-rendered in ([0-9]+) ms"))) << result.err;
    RecordProperty("milliseconds", taken[1].str());
}

TEST_F(Authoring, WatchMakesThePictureAnewWhenAModuleChanges) {
    command({"new", "mine"});
    replace("mine/effect.json", "\"inputs\"", "\"modules\": [\"tint\"], \"inputs\"");
    // A data folder of its own, where a module may be changed.
    const fs::path shipped = AFTERSHADE_SOURCE_DIR;
    fs::create_directories(folder_ / "data/effects");
    for (const char* part : {"glsl", "profiles"})
        fs::copy(shipped / part, folder_ / "data" / part, fs::copy_options::recursive);
    fs::create_directories(folder_ / "data/glsl/tint");
    write_text(folder_ / "data/glsl/tint/module.json",
               R"({"aftershade": 1, "module": "tint", "summary": "A factor.",
                   "params": {"tint": {"type": "float", "default": 1, "doc": "Factor."}}})");
    write_text(folder_ / "data/glsl/tint/tint.glsl", "vec4 tinted(vec4 c) { return c * param.tint; }\n");
    replace("mine/mine.frag", "#include <pass>", "#include <pass>\n#include <tint/tint.glsl>");
    replace("mine/mine.frag", "light.rgb *", "tinted(light).rgb *");
    write_capture(make_capture({.width = 64, .height = 36, .background = {0.5f, 0.5f, 0.5f}}),
                  folder_ / "in_0001.exr");
    Command watch({AFTERSHADE_EXECUTABLE, "run", "mine/look.json", "in_0001.exr", "--effect-path", ".", "-o",
                   "out.png", "--backend", "software", "--watch"},
                  folder_.path(), {{"AFTERSHADE_DATA", (folder_ / "data").string()}});
    ASSERT_TRUE(watch.wait_for_lines(1));
    const std::string first = read_text(folder_ / "out.png");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    replace("data/glsl/tint/tint.glsl", "c * param", "0.5 * c * param");
    ASSERT_TRUE(watch.wait_for_lines(2)) << "a shader of a module";
    const std::string second = read_text(folder_ / "out.png");
    EXPECT_NE(first, second);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    replace("data/glsl/tint/module.json", "\"default\": 1,", "\"default\": 0.25,");
    ASSERT_TRUE(watch.wait_for_lines(3)) << "the module's declarations";
    EXPECT_NE(read_text(folder_ / "out.png"), second);
    watch.send(SIGINT);
    EXPECT_EQ(watch.wait().exit_code, 130);
}

/// The first look names no object, so the frame's Cryptomatte is not read for it.
TEST_F(Authoring, WatchTakesTheNamesOfObjectsFromEachLook) {
    constexpr int kWidth = 24, kPixels = 24 * 12;
    const auto plane = [&](float value) { return std::vector<float>(kPixels, value); };
    std::vector<float> stripes = plane(0.1f);
    for (int i = 0; i < kPixels; i += 3) stripes[std::size_t(i)] = 4;
    write_channels(folder_ / "in_0001.exr", kWidth,
                   {{"R", stripes},
                    {"G", stripes},
                    {"B", stripes},
                    {"Z", plane(9)},
                    {"CryptoObject00.R", plane(std::bit_cast<float>(cryptomatte_hash("Cube")))},
                    {"CryptoObject00.G", plane(1)},
                    {"CryptoObject00.B", plane(0)},
                    {"CryptoObject00.A", plane(0)}},
                   {{"cryptomatte/3ae39a5/name", std::string("CryptoObject")},
                    {"cryptomatte/3ae39a5/manifest", std::string(R"({"Cube":"0"})")}});
    EXPECT_NE(command({"inspect", "in_0001.exr", "--cryptomatte"}).out.find("Cube"), std::string::npos)
        << "the name of the Cryptomatte may be left out";
    write_text(folder_ / "look.json",
               R"({"aftershade": 1, "steps": [{"effect": "dof_simple", "params": {"focus_distance": 2,
                   "focal_length": 50, "sensor_width": 36, "f_number": 0.1}}]})");
    Command watch({AFTERSHADE_EXECUTABLE, "run", "look.json", "in_0001.exr", "-o", "out.exr", "--backend",
                   "software", "--watch"},
                  folder_.path());
    ASSERT_TRUE(watch.wait_for_lines(1));
    const std::string blurred = read_text(folder_ / "out.exr");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    replace("look.json", "\"focus_distance\": 2", R"("focus_distance": {"from": "depth", "object": "Cube"})");
    EXPECT_TRUE(watch.wait_for_lines(2)) << "a look of names after one without";
    EXPECT_NE(read_text(folder_ / "out.exr"), blurred);
    watch.send(SIGINT);
    const CommandResult result = watch.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
}

TEST_F(Authoring, NewRefusesBadIdsAndReplacesNothing) {
    EXPECT_NE(command({"new", "Bad-Name"}, 2).err.find("must be snake_case"), std::string::npos);
    EXPECT_NE(command({"new", "sanitize"}, 2).err.find("an effect that comes with Aftershade"),
              std::string::npos);
    command({"new", "mine"});
    const std::string before = read_text(folder_ / "mine/effect.json");
    EXPECT_NE(command({"new", "mine"}, 2).err.find("is there already"), std::string::npos);
    EXPECT_EQ(read_text(folder_ / "mine/effect.json"), before);
}

TEST_F(Authoring, CheckReportsEveryKindOfFaultWithItsPlace) {
    command({"new", "mine"});
    const std::string shader = read_text(folder_ / "mine/mine.frag"),
                      manifest = read_text(folder_ / "mine/effect.json");
    const auto fault = [&](const std::string& file, const std::string& before, const std::string& after) {
        write_text(folder_ / "mine/mine.frag", shader);
        write_text(folder_ / "mine/effect.json", manifest);
        replace(file, before, after);
        return command({"check", "mine", "--backend", "software"}, 1).err;
    };
    EXPECT_TRUE(std::regex_search(fault("mine/mine.frag", "param.strength", "param.strenth"),
                                  std::regex("mine\\.frag:7:\\d+: error: .*strenth")));
    EXPECT_NE(fault("mine/mine.frag", "param.strength *", "").find("strength"), std::string::npos)
        << "declared, not used";
    EXPECT_TRUE(std::regex_search(fault("mine/mine.frag", "light.a)", "ligth.a)"),
                                  std::regex("mine\\.frag:9:\\d+: error: .*ligth")));
    const std::string bad = fault("mine/mine.frag", "1.0 - darkness", "1.0 / (param.strength - 1.0)");
    EXPECT_NE(bad.find("with strength at its max, 1: "), std::string::npos) << bad;
    EXPECT_NE(fault("mine/effect.json", "\"default\": 0.6", "\"default\": 6").find("above the maximum 1"),
              std::string::npos);
}

TEST_F(Authoring, CheckWarnsOfWhatIsSeldomMeant) {
    fs::create_directories(folder_ / "odd");
    write_text(folder_ / "odd/effect.json",
               R"({ "aftershade": 1, "id": "odd", "version": "1.0.0", "summary": "Odd.",
        "inputs": { "color": { "role": "color" }, "depth": { "role": "depth" } },
        "outputs": { "color": { "role": "color" } },
        "params": { "taps": { "type": "int", "default": 3, "min": 1, "max": 9, "doc": "." } },
        "textures": { "near": { "format": "r16f", "doc": "Depth, m." }, "spare": { "format": "r32f", "doc": "." },
                      "kept": { "format": "rgba16f", "history": true, "doc": "." } },
        "passes": [
          { "name": "near", "shader": "near.frag", "reads": ["depth"], "writes": ["near", "spare"] },
          { "name": "main", "shader": "main.frag", "reads": ["color", "near", "kept.prev"], "writes": ["color", "kept"] } ] })");
    const std::string head = "#version 450 core\n#include <pass>\n";
    write_text(
        folder_ / "odd/near.frag",
        head +
            "void main() { out_near = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r; out_spare = 0.0; }\n");
    write_text(folder_ / "odd/main.frag", head + R"(void main() {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < param.taps; ++i) sum += texelFetch(color, ivec2(gl_FragCoord.xy), 0) * min(texelFetch(near, ivec2(0), 0).r, 1.0);
    out_color = pow(max(sum, 0.0), vec4(1.0 / 2.2)) + texelFetch(kept_prev, ivec2(0), 0);
    out_kept = sum;
}
)");
    const std::string warnings = command({"check", "odd", "--no-gl"}).err;
    for (const char* expected : {"no pass reads the texture 'spare'",
                                 "the texture 'near' is made from depth but has the format r16f",
                                 "main.frag:5:5: warning: a parameter bounds this loop",
                                 "main.frag:6:17: warning: this looks like a gamma",
                                 "no shader reads frame.history_valid", "declares no warmup"})
        EXPECT_NE(warnings.find(expected), std::string::npos) << expected << "\n" << warnings;
    command({"check", "odd", "--no-gl", "--strict"}, 1);
}

TEST_F(Authoring, CheckOfALookFindsItsFaultsAndRefusesWhatItDoesNotKnow) {
    write_text(folder_ / "good.json", R"({ "aftershade": 1, "steps": [ { "effect": "view_transform" } ] })");
    write_text(folder_ / "bad.json", R"({ "aftershade": 1, "steps": [ { "effect": "view_transfrom" } ] })");
    command({"check", "good.json"});
    EXPECT_NE(command({"check", "bad.json"}, 1).err.find("did you mean 'view_transform'?"),
              std::string::npos);
    EXPECT_NE(
        command({"check", "nothing"}, 2).err.find("is not a shipped effect, an effect's folder or a look"),
        std::string::npos);
}

TEST_F(Authoring, ListAndDescribeTellWhatThereIs) {
    command({"new", "mine"});
    const auto listed = nlohmann::json::parse(command({"list", "--effect-path", ".", "--json"}).out);
    bool found = false;
    for (const auto& effect : listed) found |= effect.at("id") == "mine" && effect.at("version") == "1.0.0";
    EXPECT_TRUE(found);
    const auto described =
        nlohmann::json::parse(command({"describe", "mine", "--effect-path", ".", "--json"}).out);
    EXPECT_EQ(described.at("params").at("strength").at("default"), 0.6);
    EXPECT_EQ(described.at("params").at("strength").at("identity"), 0.0);
    EXPECT_NE(command({"describe", "mine", "--effect-path", "."}).out.find("0 to 1"), std::string::npos);
    EXPECT_NE(command({"describe", "mime", "--effect-path", "."}, 2).err.find("did you mean 'mine'?"),
              std::string::npos);
}

TEST_F(Authoring, DescribeTellsWhatEachPassTakesAndMakesAndWhatHasNoTap) {
    const std::string folder = std::string(AFTERSHADE_SOURCE_DIR) + "/tests/schema";
    const std::string text = command({"describe", "every_form", "--verbose", "--effect-path", folder}).out;
    for (const char* line : {"  count   main.comp                color, depth, winner, arguments -> winner, "
                             "list, arguments, sums\n",
                             "  spread  main.comp                state.prev -> state, coarse\n",
                             "  empty   clear                    -> half_size, slices\n",
                             "  slices     r32f, 4 layers, no tap", "  pyramid    r32f, 64 x 32, 3 levels"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
}

TEST_F(Authoring, DescribeLeadsWithTheParametersOfAnEffectOnOneScreen) {
    for (const char* effect : {"dof", "sss_adaptive", "motion_blur", "vignette"}) {
        const std::string text = command({"describe", effect}).out;
        EXPECT_LE(std::ranges::count(text, '\n'), 60) << text;
        EXPECT_LT(text.find("\nparameters\n"), text.find("\ninputs\n")) << text;
        EXPECT_EQ(text.find("\npasses\n"), std::string::npos) << text;
    }
}

TEST_F(Authoring, DocsAreWrittenOnceAndTheirDriftIsFound) {
    EXPECT_NE(command({"docs", "-o", "pages"}).out.find("pages/README.md"), std::string::npos);
    EXPECT_EQ(command({"docs", "-o", "pages"}).out, "") << "nothing changed";
    command({"docs", "-o", "pages", "--check"});
    write_text(folder_ / "pages/gone.md", "x");
    replace("pages/README.md", "# Effects", "# effects");
    replace("scene-reference.md", "# Scene", "# scene");
    const std::string drift = command({"docs", "-o", "pages", "--check"}, 1).out;
    EXPECT_NE(drift.find("pages/README.md: differs from the declarations"), std::string::npos);
    EXPECT_NE(drift.find("scene-reference.md: differs from the declarations"), std::string::npos);
    EXPECT_NE(drift.find("pages/gone.md: no effect has this page"), std::string::npos);
}

TEST_F(Authoring, DocsWritesTablesIntoMarkedRegionsOfPagesAndFindsTheirDrift) {
    const std::string begin = "# Mine\n<!-- made by aftershade docs: case.tolerance -->\n";
    const std::string end =
        "<!-- end -->\nMy own words.\n<!-- made by aftershade docs: case.case -->\n<!-- end -->\n"
        "<!-- made by aftershade docs: case.quarantine -->\n<!-- end -->\n";
    write_text(folder_ / "mine.md", begin + end);
    EXPECT_NE(command({"docs", "-o", "pages"}).out.find("mine.md"), std::string::npos);
    const std::string page = read_text(folder_ / "mine.md");
    EXPECT_TRUE(page.starts_with(begin + "| key | type |")) << page;
    EXPECT_NE(page.find("| `fail` | float | at least 0 | 1e-06 |"), std::string::npos) << page;
    EXPECT_NE(page.find("<!-- end -->\nMy own words.\n"), std::string::npos) << page;
    command({"docs", "-o", "pages", "--check"});
    replace("mine.md", "1e-06", "0.1");
    EXPECT_NE(
        command({"docs", "-o", "pages", "--check"}, 1).out.find("mine.md: differs from the declarations"),
        std::string::npos);
    write_text(folder_ / "mine.md", begin + "<!-- end -->\n");
    EXPECT_NE(command({"docs", "-o", "pages"}, 2).err.find("no page shows the table 'case.case'"),
              std::string::npos);
    replace("mine.md", "case.tolerance", "case.tolerence");
    EXPECT_NE(command({"docs", "-o", "pages"}, 2).err.find("did you mean 'case.tolerance'?"),
              std::string::npos);
}

TEST(Pages, AreWhatIsDeclared) {
    const std::string folder = std::string(AFTERSHADE_SOURCE_DIR) + "/docs/effects";
    const TemporaryFolder here;
    const CommandResult result = run_aftershade({"docs", "-o", folder, "--check"}, here.path());
    EXPECT_EQ(result.exit_code, 0) << result.out << "run: aftershade docs";
}

}  // namespace
}  // namespace aftershade::test
