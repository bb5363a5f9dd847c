// What attackers wrote, through the program: a documented exit with a reason, in 5 s of processor time and
// 500 MB.
#include <sys/stat.h>

#include <filesystem>
#include <functional>

#include "framework/batch/process_codes.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

/// Text that is repeated.
std::string times(int count, const std::string& text) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
}

/// Where the command runs: frame.exr and nothing.json are there.
struct Place {
    const TemporaryFolder& folder;

    void write(const std::string& name, const std::string& text) const { write_text(folder / name, text); }
    void write_look(const std::string& name, const std::string& steps, const std::string& more = "") const {
        write(name, R"({ "aftershade": 1, )" + more + R"("steps": [ )" + steps + " ] }");
    }
    /// The effect "bad" and look.json, which uses it. `body` changes the float c; `before` stands before
    /// main.
    void write_effect(const std::string& body, const std::string& before = "",
                      const std::string& manifest = "") const {
        fs::create_directories(folder / "effects/bad");
        write("effects/bad/effect.json",
              R"({ "aftershade": 1, "id": "bad", "version": "1.0.0", "summary": "A test.", )" + manifest +
                  R"("inputs": { "color": { "role": "color" } }, "outputs": { "color": { "role": "color" } },
                  "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ] })");
        write("effects/bad/main.frag",
              "#version 450 core\n#include <pass>\n" + before +
                  "void main() { float c = texelFetch(color, ivec2(gl_FragCoord.xy), 0).r;\n" + body +
                  "\nout_color = vec4(c); }\n");
        write_look("look.json", R"({ "effect": "bad" })");
    }
};

struct Attack {
    std::string what;  ///< as the test's name
    ExitCode exit_code = ExitCode::usage;
    std::string message;  ///< found in what the user reads; "" where the run is done
    std::function<void(const Place&)> prepare;
    std::vector<std::string> arguments{"run", "look.json", "frame.exr", "-o", "out.exr"};
};
void PrintTo(const Attack& attack, std::ostream* out) {
    *out << attack.what;
}

class AttackTest : public BatchWork, public testing::WithParamInterface<Attack> {};

TEST_P(AttackTest, EndsInADocumentedWayInFiveSecondsAnd500Megabytes) {
    write_frames(1, 1);
    fs::rename(frame_path(1), folder_ / "frame.exr");
    const Attack& attack = GetParam();
    attack.prepare({folder_});
    std::vector<std::string> arguments = attack.arguments;
    if (arguments.front() == "run") arguments.insert(arguments.end(), {"--effect-path", "effects"});
    const CommandResult result = run_aftershade(arguments, folder_.path());
    EXPECT_EQ(result.exit_code, int(attack.exit_code)) << result.err.substr(0, 1000);
    EXPECT_NE(result.err.find(attack.message), std::string::npos) << result.err.substr(0, 1000);
    EXPECT_EQ(fs::exists(folder_ / "out.exr"), attack.exit_code == ExitCode::done);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    EXPECT_LT(result.processor_s, 5);
    EXPECT_LT(result.peak_bytes, std::uint64_t(500'000'000));
#endif
}

std::vector<Attack> looks() {
    const auto uses = [](const Place& place, int count, const std::function<std::string(int)>& steps,
                         const std::string& more) {
        for (int i = 0; i < count; ++i)
            place.write_look(i == 0 ? "look.json" : std::to_string(i) + ".json", steps(i + 1), more);
        place.write_look(std::to_string(count) + ".json", "", more);
    };
    const auto use = [](int number, const std::string& name, const std::string& more = "") {
        return R"({ "use": ")" + std::to_string(number) + R"(.json", "name": ")" + name + "\"" + more + " }";
    };
    return {
        {"AChainOf20000Looks", ExitCode::usage, "the look 33 in a chain of 'use', the limit is 32",
         [=](const Place& place) {
             uses(
                 place, 20'000, [&](int next) { return use(next, "a"); }, "");
         }},
        {"LooksThatDouble", ExitCode::usage, "uses other looks more than 256 times",
         [=](const Place& place) {
             uses(
                 place, 16, [&](int next) { return use(next, "a") + ", " + use(next, "b"); }, "");
         }},
        {"VariablesThatDouble", ExitCode::usage, "variables put more than 100000 values into the look",
         [=](const Place& place) {
             const std::string twice = R"(, "vars": { "x": [ { "var": "x" }, { "var": "x" } ] })";
             uses(
                 place, 28, [&](int next) { return use(next, "a", twice); }, R"("vars": { "x": 1 }, )");
         }},
        {"EightyThousandVariables", ExitCode::usage, "the look has 80000 variables; the limit is 1000",
         [](const Place& place) {
             std::string vars = R"("vars": { "first": 1)";
             for (int i = 1; i < 80'000; ++i) vars += ", \"v" + std::to_string(i) + "\": 1";
             place.write_look("look.json", "", vars + " }, ");
         }},
        {"ARangeOf100000Blanks",
         ExitCode::done,
         "",
         [](const Place&) {},
         {"run", "nothing.json", "frame.exr", "-o", "out.exr", "--frames", times(100'000, " ") + "1"}},
        {"ARangeOfACaptureOf100000Blanks",
         ExitCode::usage,
         "capture.json:1:52: error: '",
         [](const Place& place) {
             place.write("capture.json", R"({ "aftershade": 1, "frames": "frame.exr", "range": ")" +
                                             times(100'000, " ") + "x\" }");
         },
         {"run", "nothing.json", "capture.json", "-o", "out.exr"}},
    };
}

std::vector<Attack> effects() {
    return {
        {"ALongVersionAndRequirement", ExitCode::usage, "effect.json:2:32: error: parameter 'gain': '",
         [](const Place& place) {
             place.write_effect("", "",
                                R"("params": { "gain": { "type": "float", "default": 1, "doc": ".",
                 "requires": [ "> )" +
                                    times(60'000, "g") + R"(" ] } }, )");
             const std::string text = read_text(place.folder / "effects/bad/effect.json");
             const std::size_t version = text.find("1.0.0");
             place.write("effects/bad/effect.json",
                         text.substr(0, version) + "1." + times(60'000, "9") + text.substr(version + 3));
         }},
        {"AnIncludeNameOf50000Letters", ExitCode::effect, "main.frag:3:1: error: cannot read ",
         [](const Place& place) {
             place.write_effect("", times(50'000, " ") + "#" + times(50'000, " ") + "include <" +
                                        times(50'000, "a") + ">\n");
         }},
        {"AChainOf3000Includes", ExitCode::effect, "includes go deeper than 64 files",
         [](const Place& place) {
             place.write_effect("", "#include \"0.glsl\"\n");
             for (int i = 0; i < 3'000; ++i)
                 place.write("effects/bad/" + std::to_string(i) + ".glsl",
                             "#include \"" + std::to_string(i + 1) + ".glsl\"\n");
         }},
        {"NineNestedMacros", ExitCode::effect,
         "while compiling pass 'main' of step 'bad' (effect 'bad'), frame 1",
         [](const Place& place) {
             place.write_effect("c = " + times(9, "F(") + "c" + times(9, ")") + ";",
                                "#define F(x) x*x+x*x\n");
         }},
        {"AnExpressionOf20000Terms", ExitCode::effect, "an expression has more than 10000 operators",
         [](const Place& place) { place.write_effect("c = " + times(20'000, "c + ") + "c;"); }},
        {"AnArrayOfAMillionFloats", ExitCode::effect, "an array of 1000000 elements; the limit is 65536",
         [](const Place& place) { place.write_effect("float v[1000000]; v[int(c)] = c; c = v[0];"); }},
        {"TwentyThousandLines", ExitCode::effect, "more than 20000 lines",
         [](const Place& place) { place.write_effect(times(20'001, "c = c * 1.01;\n")); }},
        {"AnIncludeThatLeadsToDevZero", ExitCode::effect, "zero.glsl leads out of the folder",
         [](const Place& place) {
             place.write_effect("", "#include \"zero.glsl\"\n");
             fs::create_symlink("/dev/zero", place.folder / "effects/bad/zero.glsl");
         }},
        {"AnIncludeThatIsAPipe", ExitCode::effect, "pipe.glsl: is not a regular file",
         [](const Place& place) {
             place.write_effect("", "#include \"pipe.glsl\"\n");
             ASSERT_EQ(mkfifo((place.folder / "effects/bad/pipe.glsl").c_str(), 0600), 0);
         }},
        {"AHistoryThatIsAPipe",
         ExitCode::usage,
         "is not a regular file",
         [](const Place& place) { ASSERT_EQ(mkfifo((place.folder / "history").c_str(), 0600), 0); },
         {"run", "trail.json", "frame.exr", "-o", "out.exr", "--history-in", "history"}},
        {"APictureOf16384Squared",
         ExitCode::usage,
         "the limit is 16 GiB (render fewer pixels at once",
         [](const Place& place) {
             place.write("scene.json",
                         R"({ "aftershade": 1, "size": [16384, 16384], "camera": {}, "objects": [
                 { "shape": "box", "size": 1 } ] })");
         },
         {"render", "scene.json", "-o", "out"}},
    };
}

INSTANTIATE_TEST_SUITE_P(OfLooks, AttackTest, testing::ValuesIn(looks()),
                         [](const auto& attack) { return attack.param.what; });
INSTANTIATE_TEST_SUITE_P(OfEffects, AttackTest, testing::ValuesIn(effects()),
                         [](const auto& attack) { return attack.param.what; });

}  // namespace
}  // namespace aftershade::test
