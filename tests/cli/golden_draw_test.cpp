// What may happen while a case is drawn: files of others, crashes, and runs that differ.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/backends.h"
#include "tests/cli/golden_suite.h"
#include "tests/cli/native_effect.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

using GoldenDraw = GoldenCommand;

TEST_F(GoldenDraw, CatchesAnOutputThatTheCaseDoesNotName) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer must be the first library that is loaded";
#endif
    fs::create_directories(folder_ / "mine/older");
    write_text(folder_ / "mine/older/effect.json",
               R"({ "aftershade": 1, "version": "1.0.0", "summary": "A test.", "id": "older",
        "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
        "params": { "gain": { "type": "float", "default": 0.5, "doc": "." } },
        "native": { "uniforms": { "gain": { "type": "float", "doc": "Gain times the frame's number." } } },
        "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ] })");
    write_text(folder_ / "mine/older/main.frag",
               "#version 450 core\n#include <pass>\nvoid main() { out_color = texelFetch(color, "
               "ivec2(gl_FragCoord.xy), 0) * native.gain; }\n");
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "effect_paths": ["mine"], "cases": [
    { "name": "tidy", "steps": [ { "effect": "older" } ], "capture": "in_####.exr", "frames": "1" } ] })");
    const std::vector<std::string> with_library = {"--plugin-path", AFTERSHADE_CASES};
    approve(with_library);
    EXPECT_EQ(run(with_library).exit_code, 0);
    // No plug-in can write a file any more, so a library that is loaded into the program does.
    const std::string litters = AFTERSHADE_CASES "/preload/litters.so";
    for (const std::string name : {"stray.exr", "0002.exr"}) {
        const Environment littering = {{"LITTER", name}, {"LD_PRELOAD", litters}};
        const CommandResult result = run(with_library, littering);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE(result.err.find("FAILED tidy: failure\n    an output that the case does not name: " + name),
                  std::string::npos)
            << result.err;
        const Json document = report(with_library, littering);
        EXPECT_TRUE(all_bits_equal(document)) << "nothing else is wrong";
        EXPECT_TRUE(document["cases"][0]["approve"].is_null()) << "no new image makes it pass";
        const CommandResult approval =
            golden({"approve", "golden.json", "--plugin-path", AFTERSHADE_CASES}, littering);
        EXPECT_EQ(approval.exit_code, 2) << approval.err;
        EXPECT_NE(approval.err.find(name), std::string::npos) << approval.err;
    }
}

TEST_F(GoldenDraw, WarnsOfACrashThatDoesNotHappenTwice) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "this sanitizer must be the first library that is loaded";
#endif
    approve();
    const auto crashing = [&](const std::string& verb, const std::string& name, const char* count) {
        return golden({verb, "golden.json", "--filter", "corner"},
                      {{"CRASHES", (folder_ / name).string()},
                       {"COUNT", count},
                       {"LD_PRELOAD", AFTERSHADE_CASES "/preload/crashes_few.so"}});
    };
    const CommandResult once = crashing("run", "once", "1");
    EXPECT_EQ(once.exit_code, 1) << once.err;
    EXPECT_NE(once.err.find("rendering: the worker crashed (signal 11, SIGSEGV); it was run once more"),
              std::string::npos)
        << once.err;
    EXPECT_NE(once.err.find("0 passed, 1 with warnings, 0 failed"), std::string::npos) << once.err;
    const CommandResult approval = crashing("approve", "approval", "1");
    EXPECT_EQ(approval.exit_code, 1) << approval.err;
    EXPECT_NE(approval.err.find("WARNING corner: approved\n"), std::string::npos) << approval.err;
    const CommandResult twice = crashing("run", "twice", "2");
    EXPECT_EQ(twice.exit_code, 2) << twice.err;
    EXPECT_NE(twice.err.find("rendering: the worker crashed (signal 11, SIGSEGV)\n"), std::string::npos)
        << twice.err;
}

TEST_F(GoldenDraw, RepeatedNamesTheFirstPassThatIsNotTheSameTwice) {
    write_native_effect(folder_.path(), "wanders");
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "effect_paths": ["effects"], "cases": [
    { "name": "steady", "steps": [ { "effect": "bokeh" }, { "effect": "vignette" } ], "capture": "in_####.exr", "frames": "1",
      "tolerance": { "fail": 1e9 } },
    { "name": "unsteady", "steps": [ { "effect": "vignette" }, { "effect": "wanders" }, { "effect": "bokeh" } ],
      "capture": "in_####.exr", "frames": "1", "tolerance": { "fail": 1e9 } } ] })");
    approve({"--plugin-path", AFTERSHADE_CASES});
    EXPECT_LT(run({"--plugin-path", AFTERSHADE_CASES}).exit_code, 2) << "the tolerance hides it";
    const CommandResult result = run({"--plugin-path", AFTERSHADE_CASES, "--repeat", "3"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(
        result.err.find("FAILED unsteady: failure\n    not deterministic: run 2 of 3 gave other bits in "
                        "unsteady.color.0001; the first pass whose result differs is 'wanders.main' "
                        "(unsteady.wanders.color.0001)\n"),
        std::string::npos)
        << result.err;
    EXPECT_EQ(result.err.find("FAILED steady"), std::string::npos) << result.err;
}

// ---- what changes no bit ----

TEST_F(GoldenDraw, GivesTheSameBitsOnBothBackendsWithAnyThreadsAndVectors) {
    approve();
    EXPECT_TRUE(all_bits_equal(report({"-j", "1"})));
    EXPECT_TRUE(all_bits_equal(report({"-j", "2"}, {{"LP_NUM_THREADS", "1"}})));
    for (const char* backend : {"egl-software", "osmesa"}) {
        if (!gpu::why_not(*gpu::parse_backend(backend)).empty()) continue;
        const Json one = report({"--backend", backend});
        EXPECT_EQ(one["environment"]["backend"], "software");
        EXPECT_TRUE(all_bits_equal(one)) << backend;
        EXPECT_EQ(one["cases"][0]["images"][0]["tier"], "bits") << "one driver under both";
    }
    const Json narrow = report({}, {{"LP_NATIVE_VECTOR_WIDTH", "128"}});
    ASSERT_NE(narrow["environment"]["renderer"].get<std::string>().find("128 bits"), std::string::npos);
    EXPECT_TRUE(all_bits_equal(narrow));
    EXPECT_EQ(narrow["cases"][0]["images"][0]["tier"], "bits") << "the width decides no bit";
    EXPECT_EQ(narrow["exit_code"], 0);
}

}  // namespace
}  // namespace aftershade::test
