// Native plug-ins through the command: what they compute is drawn, and what goes wrong in them is told.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "framework/file/png_file.h"
#include "tests/cli/command.h"
#include "tests/cli/native_effect.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

const std::string kExamples = AFTERSHADE_EXAMPLES;
const std::vector<std::string> kRed{"R"};

class Plugins : public testing::Test {
protected:
    Plugins() {
        for (int frame = 1; frame <= 4; ++frame) {
            SyntheticScene scene{.width = 48, .height = 32, .background = {0.25f, 0.25f, 0.25f}};
            scene.points = {{24, 16, 64}};
            write_capture(make_capture(scene, frame), folder_ / ("in_000" + std::to_string(frame) + ".exr"));
        }
    }

    void write_effect(const std::string& id) {
        write_native_effect(folder_.path(), id);
        write_text(folder_ / "look.json",
                   R"({ "aftershade": 1, "steps": [ { "effect": ")" + id + R"(", "name": "graded" } ] })");
    }

    CommandResult run(std::vector<std::string> more, int exit_code) {
        std::vector<std::string> arguments{"run",       "look.json", "in_####.exr",  "-o",   "out_####.exr",
                                           "--backend", "software",  "--pixel-type", "float"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        CommandResult result = run_aftershade(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result;
    }
    Image red(const std::string& name) { return ExrFile(folder_ / name).read_floats(0, kRed); }

    TemporaryFolder folder_;
};

TEST_F(Plugins, FillUniformsEveryFrame) {
    write_effect("older");
    run({"--effect-path", "effects", "--plugin-path", kCases}, 0);
    for (int frame = 1; frame <= 4; ++frame)
        EXPECT_FLOAT_EQ(red("out_000" + std::to_string(frame) + ".exr").at(3, 3, 0),
                        0.25f * 0.5f * float(frame));
}

TEST_F(Plugins, FillTablesThatShadersRead) {
    write_text(folder_ / "look.json",
               R"({ "aftershade": 1, "steps": [ { "effect": "gauss_table", "params": { "sigma": 2 } } ] })");
    run({"--effect-path", std::string(AFTERSHADE_SOURCE_DIR) + "/examples/plugins/kernel_c", "--plugin-path",
         kExamples, "--frames", "1"},
        0);
    const Image out = red("out_0001.exr");
    double sum = 0;
    for (int i = -6; i <= 6; ++i) sum += std::exp(-0.5 * i * i / 4);
    for (int dx = 0; dx <= 4; ++dx) {
        const double weight = std::exp(-0.5 * dx * dx / 4) / (sum * sum);
        EXPECT_NEAR(out.at(24 + dx, 16, 0), 0.25 + 64 * weight, 2e-3 * 64 * weight + 1e-4) << dx;
    }
}

TEST_F(Plugins, ThatCrashEndTheRunWithTheirNameAndLeaveEarlierFramesWhole) {
    write_effect("crashes_late");
    const CommandResult result = run({"--effect-path", "effects", "--plugin-path", kCases}, 5);
    EXPECT_NE(result.err.find("plug-in " + kCases +
                              "/crashes_late.so crashed (signal 11, SIGSEGV) in prepare of step "
                              "'graded', frame 3"),
              std::string::npos)
        << result.err;
    EXPECT_FLOAT_EQ(red("out_0001.exr").at(3, 3, 0), 0.125f);
    EXPECT_FLOAT_EQ(red("out_0002.exr").at(3, 3, 0), 0.25f);
    EXPECT_FALSE(fs::exists(folder_ / "out_0003.exr"));
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        EXPECT_EQ(entry.path().filename().string().find("tmp"), std::string::npos) << entry.path();
}

TEST_F(Plugins, ThatCrashOrHangCostWorkersOneFrame) {
    write_effect("crashes_late");
    const CommandResult crash = run({"--effect-path", "effects", "--plugin-path", kCases, "--jobs", "1"}, 1);
    EXPECT_NE(crash.err.find("1 of 4 frames failed:\n  frame 3: plug-in " + kCases +
                             "/crashes_late.so crashed (signal 11, SIGSEGV)"),
              std::string::npos)
        << crash.err;
    EXPECT_FALSE(fs::exists(folder_ / "out_0003.exr"));
    EXPECT_FLOAT_EQ(red("out_0004.exr").at(3, 3, 0), 0.5f);
    write_effect("hangs");
    const CommandResult hang = run(
        {"--effect-path", "effects", "--plugin-path", kCases, "--frames", "1", "--frame-timeout", "3"}, 5);
    EXPECT_NE(hang.err.find("did not finish within 3 s and was killed"), std::string::npos) << hang.err;
}

TEST_F(Plugins, ThatHangAreStopped) {
    write_effect("hangs");
    const CommandResult result =
        run({"--effect-path", "effects", "--plugin-path", kCases, "--plugin-timeout", "1"}, 5);
    EXPECT_NE(result.err.find("hangs.so"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("step 'graded', frame 1"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("--plugin-timeout"), std::string::npos) << result.err;
}

// A process that dies before its first word closes its pipe; the time limit of a call, a minute, is not
// waited for.
TEST_F(Plugins, WhoseMemoryLimitIsBelowTheirStartEndTheRunAtOnce) {
    write_effect("older");
    const auto start = std::chrono::steady_clock::now();
    const CommandResult result =
        run({"--effect-path", "effects", "--plugin-path", kCases, "--plugin-memory", "1MB"}, 5);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
    EXPECT_NE(result.err.find("in the start of its process; give it more memory with --plugin-memory"),
              std::string::npos)
        << result.err;
}

TEST_F(Plugins, ThatExitOrThrowAreErrorsOfTheStep) {
    for (const char* id : {"exits", "throws"}) {
        write_effect(id);
        const CommandResult result = run({"--effect-path", "effects", "--plugin-path", kCases}, 5);
        EXPECT_NE(result.err.find("graded"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(std::string(id) + ".so"), std::string::npos) << result.err;
    }
}

TEST_F(Plugins, ThatEndBadlyAfterTheLastFrameMakeNoRunAndNoCheckSucceed) {
    for (const std::string id : {"aborts_last", "exits_last", "hangs_last"}) {
        write_effect(id);
        const std::vector<std::string> plugins{"--effect-path", "effects",          "--plugin-path",
                                               kCases,          "--plugin-timeout", "1"};
        for (const char* jobs : {"", "2"}) {
            std::vector<std::string> words = plugins;
            words.insert(words.end(), {"--overwrite", "--report", "report.json"});
            if (*jobs) words.insert(words.end(), {"--jobs", jobs});
            const CommandResult result = run(words, 5);
            EXPECT_NE(result.err.find(id + ".so"), std::string::npos) << result.err;
            EXPECT_NE(result.err.find("in destroy of step 'graded'"), std::string::npos) << result.err;
            EXPECT_TRUE(fs::exists(folder_ / "out_0004.exr")) << "frames before it are whole";
            const std::string report = read_text(folder_ / "report.json");
            EXPECT_NE(report.find("\"exit_code\": 5"), std::string::npos) << report;
            EXPECT_NE(report.find("in destroy"), std::string::npos) << report;
        }
        std::vector<std::string> check{"check", id, "--backend", "software"};
        check.insert(check.end(), plugins.begin(), plugins.end());
        const CommandResult checked = run_aftershade(check, folder_.path());
        EXPECT_EQ(checked.exit_code, 1) << checked.err;
        EXPECT_NE(checked.err.find("in destroy"), std::string::npos) << checked.err;
    }
}

TEST_F(Plugins, AreNeverTakenFromBesideALook) {
    write_effect("older");
    fs::copy_file(kCases + "/older.so", folder_ / "older.so");
    fs::copy_file(kCases + "/older.so", folder_ / "effects/older/older.so");
    const CommandResult result = run({"--effect-path", "effects"}, 5);
    EXPECT_NE(result.err.find("no library offers native code for the effect 'older'"), std::string::npos)
        << result.err;
}

}  // namespace
}  // namespace aftershade::test
