// What strangers wrote: each fault of a plug-in or a shader is an exit with a reason, and plug-ins are kept
// from everything but their work.
#include <gtest/gtest.h>

#include <regex>

#include "framework/effect/native/confinement.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

const std::string kCases = AFTERSHADE_CASES;
constexpr const char* kBehaviours[] = {"work",   "exit_0",    "exit_5", "exit_6",   "exit_130",
                                       "crash",  "abort",     "sleep",  "spin",     "talk",
                                       "escape", "memory",    "lie",    "lie_long", "environment",
                                       "files",  "processes", "others", "sockets",  "nothing"};

class Strangers : public testing::Test {
protected:
    Strangers() {
        SyntheticScene scene{.width = 16, .height = 9, .background = {0.25f, 0.25f, 0.25f}};
        for (int frame = 1; frame <= 2; ++frame)
            write_capture(make_capture(scene, frame), folder_ / ("in_000" + std::to_string(frame) + ".exr"));
    }

    /// `manifest` stands between the parameters and the passes.
    void write_effect(const std::string& id, const std::string& shader, const std::string& manifest = "") {
        fs::create_directories(folder_ / "effects" / id);
        write_text(folder_ / "effects" / id / "effect.json",
                   R"({ "aftershade": 1, "version": "1.0.0", "summary": "A test.", "id": ")" + id + R"(",
            "inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } }, )" +
                       manifest +
                       R"( "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"],
                                         "writes": ["color"] } ] })");
        write_text(folder_ / "effects" / id / "main.frag", "#version 450 core\n#include <pass>\n" + shader);
        write_text(folder_ / "look.json",
                   R"({ "aftershade": 1, "steps": [ { "effect": ")" + id + R"(", "name": "graded" } ] })");
    }
    /// What `body` makes of the float c.
    void write_shader(const std::string& id, const std::string& body, const std::string& before = "") {
        write_effect(id, before +
                             "void main() { float c = texelFetch(color, ivec2(gl_FragCoord.xy), 0).r;\n" +
                             body + "\nout_color = vec4(c); }\n");
    }
    /// The effect of behaves.c with these behaviours; the first is the default. Its colour is the uniform.
    template <class Behaviours>
    void write_plugin_effect(const Behaviours& behaviours) {
        std::string values;
        for (const std::string_view behaviour : behaviours)
            values += (values.empty() ? "\"" : ", \"") + std::string(behaviour) + "\"";
        const std::string first = std::string(*std::begin(behaviours));
        write_effect("behaves",
                     "void main() { out_color = texelFetch(color, ivec2(gl_FragCoord.xy), 0) * 0.0 + "
                     "native.gain; }\n",
                     R"("params": { "what": { "type": "enum", "values": [)" + values + R"(], "default": ")" +
                         first + R"(", "doc": "." } },
            "native": { "uniforms": { "gain": { "type": "float", "doc": "." } } },)");
    }

    CommandResult aftershade(std::vector<std::string> arguments, Environment environment = {}) const {
        arguments.insert(arguments.end(), {"--effect-path", "effects"});
        environment.try_emplace("AFTERSHADE_BACKEND", "software");
        return run_aftershade(arguments, folder_.path(), environment);
    }
    CommandResult run(const std::vector<std::string>& more, const Environment& environment = {}) const {
        std::vector<std::string> arguments{"run",      "look.json", "in_####.exr", "-o", "out_####.exr",
                                           "--frames", "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return aftershade(arguments, environment);
    }
    float red() const {
        return ExrFile(folder_ / "out_0001.exr").read_floats(0, std::vector<std::string>{"R"}).at(3, 3, 0);
    }

    TemporaryFolder folder_;
};

bool has(const std::string& text, const std::string& pattern) {
    return std::regex_search(text, std::regex(pattern));
}

// ---- plug-ins ----

struct Behaviour {
    std::string what;
    std::string message;  ///< a regular expression; "" where the run is done
    float gain = 0;       ///< of a run that is done
    std::vector<std::string> options{};
};
void PrintTo(const Behaviour& behaviour, std::ostream* out) {
    *out << behaviour.what;
}

class PluginThat : public Strangers, public testing::WithParamInterface<Behaviour> {};

TEST_P(PluginThat, CostsItsFrameAtMost) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    if (GetParam().what == "memory") GTEST_SKIP() << "the sanitizer needs all of the address space";
#endif
    const Confinement offered = offered_confinement();
    if (!offered.seccomp || offered.landlock_abi < 1)
        GTEST_SKIP() << "this kernel does not confine plug-ins: `aftershade doctor`";
    const Behaviour& behaviour = GetParam();
    write_plugin_effect(kBehaviours);
    fs::create_directory(folder_ / "home");
    write_text(folder_ / "home/victim.txt", "mine");
    std::vector<std::string> options{"--plugin-path", kCases, "--set", "graded.what=" + behaviour.what};
    options.insert(options.end(), behaviour.options.begin(), behaviour.options.end());
    const CommandResult result = run(options, {{"SECRET_TOKEN", "secret"},
                                               {"HOME", (folder_ / "home").string()},
                                               {"MESA_SHADER_CACHE_DIR", (folder_ / "mesa").string()}});
    EXPECT_EQ(read_text(folder_ / "home/victim.txt"), "mine");
    EXPECT_EQ(contents(folder_ / "home").size(), 1u) << "a file was made";
    if (behaviour.message.empty()) {
        EXPECT_EQ(result.exit_code, 0) << result.err;
        if (result.exit_code == 0) {
            EXPECT_EQ(red(), behaviour.gain);
        }
        return;
    }
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_TRUE(has(result.err, "aftershade: error: plug-in " + kCases + "/behaves\\.so " +
                                    behaviour.message + " in prepare of step 'graded', frame 1"))
        << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "out_0001.exr"));
}

std::vector<Behaviour> behaviours() {
    const std::vector<std::string> a_second{"--plugin-timeout", "1"};
    const std::string late = "did not finish within 1 s and was killed";
    return {{"crash", "crashed \\(signal 11, SIGSEGV\\)"},
            {"abort", "crashed \\(signal 6, SIGABRT\\)"},
            {"exit_0", "ended the process with code 0"},
            {"exit_5", "ended the process with code 5"},
            {"exit_6", "ended the process with code 6"},
            {"exit_130", "ended the process with code 130"},
            {"sleep", late, 0, a_second},
            {"spin", late, 0, a_second},
            {"talk", late, 0, a_second},
            {"lie", "broke into the host's own talk with its process"},
            {"lie_long", "sent a message that is too long"},
            {"memory", "", 0, {"--plugin-memory", "500MB"}},
            {"environment", "", 0},
            {"files", "", 0},
            {"processes", "", 0},
            {"others", "", 0},
            {"sockets", "", 0},
            {"work", "", 1}};
}

INSTANTIATE_TEST_SUITE_P(Would, PluginThat, testing::ValuesIn(behaviours()),
                         [](const auto& behaviour) { return behaviour.param.what; });

TEST_F(Strangers, PluginsHaveOneTimeLimitWithWorkersAndWithout) {
    write_plugin_effect(kBehaviours);
    const CommandResult result = run(
        {"--plugin-path", kCases, "--set", "graded.what=sleep", "--plugin-timeout", "0.5", "--jobs", "1"});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_TRUE(has(result.err,
                    "1 of 1 frame failed:\n  frame 1: plug-in .*behaves\\.so did not finish within 0\\.5 "
                    "s and was killed in prepare of step 'graded', frame 1; give it longer with "
                    "--plugin-timeout"))
        << result.err;
}

TEST_F(Strangers, PluginsDoNotTakeTheTerminalOver) {
    write_plugin_effect(kBehaviours);
    const CommandResult result = run({"--plugin-path", kCases, "--set", "graded.what=escape"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("?[2Jcleared"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find('\033'), std::string::npos);
    EXPECT_EQ(result.out, "out_0001.exr\n") << "what a plug-in prints is no path of a file";
}

TEST_F(Strangers, PluginsCannotMakeACheckSucceed) {
    for (const std::string behaviour : {"exit_0", "crash", "sleep"}) {
        write_plugin_effect(std::vector<std::string>{behaviour, "work"});
        const CommandResult result =
            aftershade({"check", "behaves", "--plugin-path", kCases, "--plugin-timeout", "0.3"});
        EXPECT_EQ(result.exit_code, 1) << result.err;
        EXPECT_TRUE(
            has(result.err, "behaves/effect\\.json: error: with the defaults: plug-in .*behaves\\.so"))
            << result.err;
        EXPECT_TRUE(has(result.out, "behaves: [1-9] errors?\\b")) << result.out;
    }
}

TEST_F(Strangers, AWorkerThatEndsWithoutItsLastWordHasFailed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer must be the first library that is loaded";
#endif
    write_shader("plain", "");
    for (const std::string code : {"0", "5", "130"}) {
        const CommandResult result = run({}, {{"QUIT", code}, {"LD_PRELOAD", kCases + "/preload/quits.so"}});
        EXPECT_EQ(result.exit_code, 5) << result.err;
        EXPECT_NE(result.err.find("aftershade: error: the worker ended with code " + code +
                                  " before its work was done"),
                  std::string::npos)
            << result.err;
    }
}

// ---- shaders ----

TEST_F(Strangers, AShaderThatCrashesTheDriverIsNamed) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer reports the driver's crash in its own words";
#endif
    // Mesa's compiler recurses over the expression, which has a quarter of a million terms once the macros
    // are expanded.
    write_shader("deep", "c = F(F(F(F(F(F(F(F(F(c)))))))));", "#define F(x) x*x+x*x\n");
    const std::string crash =
        "the GL driver crashed \\(signal 11, SIGSEGV\\) while compiling pass 'main' of step '";
    const CommandResult result = run({});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_TRUE(has(result.err, "aftershade: error: " + crash + "graded' \\(effect 'deep'\\), frame 1"))
        << result.err;
    const CommandResult by_jobs = run({"--jobs", "1"});
    EXPECT_EQ(by_jobs.exit_code, 5) << by_jobs.err;
    EXPECT_TRUE(has(by_jobs.err, "frame 1: " + crash)) << by_jobs.err;
    const CommandResult check = aftershade({"check", "deep"});
    EXPECT_EQ(check.exit_code, 5) << check.err;
    EXPECT_TRUE(has(check.err, crash + "deep' \\(effect 'deep'\\)")) << check.err;
}

TEST_F(Strangers, AShaderThatTakesTooLongIsNamed) {
    std::string lines;
    for (int i = 0; i < 6'000; ++i) lines += "c = c * 1.01 + sin(c * " + std::to_string(i) + ".0);\n";
    write_shader("long", lines);
    const std::string late =
        "the GL driver did not finish within 0\\.5 s and was killed while "
        "(compiling|drawing) pass 'main' of step '";
    const CommandResult result = run({"--pass-timeout", "0.5"});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_TRUE(has(result.err, late +
                                    "graded' \\(effect 'long'\\), frame 1; make the pass cheaper, or give it "
                                    "longer with --pass-timeout"))
        << result.err;
    const CommandResult by_jobs = run({"--jobs", "1", "--pass-timeout", "0.5"});
    EXPECT_EQ(by_jobs.exit_code, 5) << by_jobs.err;
    EXPECT_TRUE(has(by_jobs.err, "frame 1: " + late)) << by_jobs.err;
    const CommandResult check = aftershade({"check", "long", "--pass-timeout", "0.5"});
    EXPECT_EQ(check.exit_code, 5) << check.err;
    EXPECT_TRUE(has(check.err, late)) << check.err;
}

// Mesa's llvmpipe ends loops after 65,535 iterations; from some version on it does not.
constexpr const char* kLoopFault =
    "pass 'graded\\.main': llvmpipe ended its loops after 65,535 iterations, so the picture is wrong";

TEST_F(Strangers, ALoopThatTheDriverEndedIsAnErrorOfTheAuditAndTheCheck) {
    write_shader("endless", "while (c < 1.0e30) c = max(c, 1.0) + 0.0 * c;");
    const CommandResult plain = run({"--pass-timeout", "3"});
    if (plain.exit_code != 0) {
        EXPECT_TRUE(has(plain.err, "the GL driver did not finish within 3 s .* drawing pass 'main'"))
            << plain.err;
        GTEST_SKIP() << "this llvmpipe ends no loop";
    }
    const CommandResult audit = run({"--audit"});
    EXPECT_EQ(audit.exit_code, 5) << audit.err;
    EXPECT_TRUE(has(audit.err, kLoopFault)) << audit.err;
    const CommandResult check = aftershade({"check", "endless"});
    EXPECT_EQ(check.exit_code, 1) << check.err;
    EXPECT_TRUE(has(check.err, "pass 'endless\\.main': llvmpipe ended its loops")) << check.err;
}

TEST_F(Strangers, LoopsThatEndByThemselvesPassTheAudit) {
    // Together they stay below the limit; macros hide one from any reading of the text.
    write_shader("bounded",
                 "for (int i = 0; i < 30000; ++i) c += 1.0e-6;\n"
                 "FOR(i, 30000) c += 1.0e-6;",
                 "#define FOR(i, n) for (int i = 0; i < n; ++i)\n");
    const CommandResult below = run({"--audit"});
    EXPECT_EQ(below.exit_code, 0) << below.err;
    write_shader("beyond",
                 "for (int i = 0; i < 40000; ++i) c += 1.0e-6;\n"
                 "FOR(i, 30000) c += 1.0e-6;",
                 "#define FOR(i, n) for (int i = 0; i < n; ++i)\n");
    const float before =
        ExrFile(folder_ / "in_0001.exr").read_floats(0, std::vector<std::string>{"R"}).at(3, 3, 0);
    const CommandResult beyond = run({"--audit"});
    if (beyond.exit_code == 0) {
        EXPECT_NEAR(red(), before + 0.07f, 2e-3f) << "the audit passes what is whole";
        return;
    }
    EXPECT_EQ(beyond.exit_code, 5) << beyond.err;
    EXPECT_TRUE(has(beyond.err, kLoopFault)) << beyond.err;
}

TEST_F(Strangers, TheAuditChangesNoBitOfAPicture) {
    fs::create_directory(folder_ / "effects");
    write_text(folder_ / "look.json",
               R"({ "aftershade": 1, "steps": [ { "effect": "bokeh" }, { "effect": "view_transform" } ] })");
    ASSERT_EQ(run({"--pixel-type", "float"}).exit_code, 0);
    const auto floats = [&] {
        const Image image = ExrFile(folder_ / "out_0001.exr").read_floats(0, kRgba);
        return std::vector<float>(image.floats().begin(), image.floats().end());
    };
    const std::vector<float> plain = floats();
    const CommandResult audit = run({"--pixel-type", "float", "--audit"});
    ASSERT_EQ(audit.exit_code, 0) << audit.err;
    EXPECT_EQ(floats(), plain);
}

}  // namespace
}  // namespace aftershade::test
