// What authors of effects read: check, run and list with faults, hints and warnings.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "tests/capture/capture_files.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class EffectMessages : public testing::Test {
protected:
    CommandResult command(std::vector<std::string> arguments, int exit_code = 0) {
        CommandResult result = run_aftershade(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
        return result;
    }
    void write_frame() {
        write_capture(make_capture({.width = 16, .height = 8, .background = {0.5f, 0.5f, 0.5f}}),
                      folder_ / "in_0001.exr");
    }
    /// An effect of one pass from `role` to itself; `expression` is what the pass writes.
    void write_effect(const std::string& id, const std::string& role, const std::string& expression) {
        const std::string image = R"({")" + role + R"(": {"role": ")" + role + R"(", "doc": "An image."}})";
        fs::create_directories(folder_ / id);
        write_text(folder_ / id / "effect.json", R"({"aftershade": 1, "id": ")" + id +
                                                     R"(", "version": "1.0.0", "summary": "A test.",
                       "inputs": )" + image + R"(, "outputs": )" +
                                                     image + R"(,
                       "params": {"strength": {"type": "float", "default": 1, "min": 0, "max": 1, "doc": "S."}},
                       "passes": [{"name": "main", "shader": "main.frag"}]})");
        write_text(folder_ / id / "main.frag",
                   "#version 450 core\n#include <pass>\nvoid main() { vec4 c = texelFetch(" + role +
                       ", ivec2(gl_FragCoord.xy), 0); out_" + role + " = " + expression + "; }\n");
    }
    TemporaryFolder folder_;
};

TEST_F(EffectMessages, CheckGivesAnEffectOfDisplayItsPicture) {
    write_effect("invert", "display", "vec4(1.0 - c.rgb * param.strength, c.a)");
    EXPECT_EQ(command({"check", "invert", "--backend", "software"}).out, "invert: 0 errors, 0 warnings\n");
}

TEST_F(EffectMessages, RunOffersTheNameThatWasMeantAsCheckDoes) {
    write_frame();
    write_effect("dim", "color", "c * param.strenght");
    write_text(folder_ / "look.json", R"({"aftershade": 1, "steps": [{"effect": "dim"}]})");
    const std::string hint =
        "dim/main.frag:3:86: error: 'param.strenght' is not a parameter of the effect; did you mean "
        "'strength'?\n";
    const CommandResult run = command(
        {"run", "look.json", "in_0001.exr", "--effect-path", ".", "-o", "out.exr", "--backend", "software"},
        5);
    EXPECT_NE(run.err.find(hint), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("cannot access field"), std::string::npos) << run.err;
    const CommandResult check = command({"check", "dim", "--backend", "software"}, 1);
    EXPECT_NE(check.err.find(hint), std::string::npos) << check.err;
}

TEST_F(EffectMessages, RunNamesThePassThatWritesNothingAndItsPictureIsZero) {
    write_frame();
    write_effect("dim", "color", "c");
    write_text(folder_ / "dim/effect.json",
               R"({"aftershade": 1, "id": "dim", "version": "1.0.0", "summary": "A test.",
                   "inputs": {"color": {"role": "color", "doc": "An image."}},
                   "outputs": {"color": {"role": "color", "doc": "An image."}},
                   "passes": [{"name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"]}]})");
    write_text(folder_ / "look.json", R"({"aftershade": 1, "steps": [{"effect": "dim"}]})");
    for (const char* shader : {"void main() {}", "void main() { if (color_size.x < 0) discard; }"}) {
        write_text(folder_ / "dim/main.frag",
                   std::string("#version 450 core\n#include <pass>\n") + shader + "\n");
        const CommandResult run = command({"run", "look.json", "in_0001.exr", "--effect-path", ".", "-o",
                                           "out.exr", "--backend", "software", "--pixel-type", "float"});
        EXPECT_NE(run.err.find("pass 'main': 'main.frag' writes nothing to 'out_color'"), std::string::npos)
            << run.err;
        const Image color =
            ExrFile(folder_ / "out.exr").read_floats(0, std::vector<std::string>{"R", "G", "B", "A"});
        EXPECT_TRUE(std::ranges::all_of(color.floats(), [](float value) { return value == 0; })) << shader;
    }
}

TEST_F(EffectMessages, NameAWriteThatIsNotDeclaredAndWhatWasMeant) {
    write_frame();
    write_effect("dim", "color", "c");
    write_text(folder_ / "look.json", R"({"aftershade": 1, "steps": [{"effect": "dim"}]})");
    const std::string shader = read_text(folder_ / "dim/main.frag"),
                      manifest = read_text(folder_ / "dim/effect.json");
    const auto write = [&](const std::string& target, const std::string& writes) {
        std::string changed = shader;
        changed.replace(changed.find("out_color"), 9, target);
        write_text(folder_ / "dim/main.frag", changed);
        const std::string pass = R"("shader": "main.frag")";
        changed = manifest;
        changed.replace(changed.find(pass), pass.size(), pass + R"(, "writes": [")" + writes + "\"]");
        write_text(folder_ / "dim/effect.json", changed);
    };
    const auto expect_both = [&](const std::string& message, int run_code) {
        const CommandResult check = command({"check", "dim", "--backend", "software"}, 1);
        EXPECT_NE(check.err.find(message), std::string::npos) << check.err;
        const CommandResult run = command({"run", "look.json", "in_0001.exr", "--effect-path", ".", "-o",
                                           "out.exr", "--backend", "software"},
                                          run_code);
        EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    };
    write("out_colour", "color");
    expect_both("'out_colour' is not a target of a pass with this shader; did you mean 'out_color'?", 5);
    write("out_color", "colour");
    expect_both("writes 'colour', which is neither an output nor a texture; did you mean 'color'?", 2);
}

TEST_F(EffectMessages, NameTheCycleOfStepsAndOfPassesWithTheWayOut) {
    write_frame();
    write_text(folder_ / "look.json", R"({"aftershade": 1, "steps": [
        {"effect": "sharpen", "in": {"color": "vignette.color"}}, {"effect": "vignette"}]})");
    const CommandResult steps = command({"run", "look.json", "in_0001.exr", "-o", "out.exr"}, 2);
    EXPECT_NE(steps.err.find("error: no step 'vignette' before 'sharpen'; a step reads outputs of "
                             "earlier steps only\n"),
              std::string::npos)
        << steps.err;

    write_effect("loop", "color", "c");
    std::string manifest = read_text(folder_ / "loop/effect.json");
    manifest.replace(manifest.find(R"("passes")"), std::string::npos, R"(
        "textures": {"a": {"format": "r16f", "doc": "A."}, "b": {"format": "r16f", "doc": "B."}},
        "passes": [{"name": "one", "shader": "main.frag", "reads": ["b"], "writes": ["a"]},
                   {"name": "two", "shader": "main.frag", "reads": ["a"], "writes": ["b"]}]})");
    write_text(folder_ / "loop/effect.json", manifest);
    const CommandResult passes = command({"check", "loop", "--no-gl"}, 1);
    EXPECT_NE(passes.err.find("pass 'one': reads 'b' before any pass has written it (write or clear it in an "
                              "earlier pass; with \"history\": true, 'b.prev' is the previous frame's)"),
              std::string::npos)
        << passes.err;
}

TEST_F(EffectMessages, CheckPutsEachFaultOfAShaderOnItsOwnLine) {
    write_effect("dim", "color", "mixx(c, param.strength) + clamp(1, vec2(0), 2.0)");
    const CommandResult check = command({"check", "dim", "--backend", "software"}, 1);
    int faults = 0;
    for (const std::string& line : lines_of_text(check.err)) {
        EXPECT_EQ(line.find('?'), std::string::npos) << line;
        if (line.find("dim/main.frag:3:") != std::string::npos) ++faults;
    }
    EXPECT_GE(faults, 2) << check.err;
    EXPECT_LE(faults, 4) << "the candidates for clamp are one line\n" << check.err;
}

TEST_F(EffectMessages, WarnOfEffectsThatHideAnother) {
    for (const char* path : {"a", "b"}) {
        write_effect(std::string(path) + "/bloom", "color", "c * param.strength");
        std::string manifest = read_text(folder_ / path / "bloom/effect.json");
        manifest.replace(manifest.find(std::string(path) + "/bloom"), 7, "bloom");
        write_text(folder_ / path / "bloom/effect.json", manifest);
    }
    const CommandResult list = command({"list", "--effect-path", "a", "--effect-path", "b"});
    EXPECT_NE(list.err.find("a/bloom: warning: hides the effect 'bloom' of b/bloom (rename one of them)\n"),
              std::string::npos)
        << list.err;
    EXPECT_NE(list.err.find("effects/bloom (rename one of them)\n"), std::string::npos) << "the shipped one\n"
                                                                                        << list.err;
    const fs::path shipped = fs::path(AFTERSHADE_SOURCE_DIR) / "effects";
    EXPECT_EQ(command({"list", "--effect-path", shipped.string()}).err, "") << "the same folder";
}

TEST_F(EffectMessages, ExplainWritesTablesAsALookDoes) {
    write_frame();
    write_text(folder_ / "look.json", R"({"aftershade": 1, "steps": [{"effect": "motion_blur", "params":
        {"objects": {"rows": [{"object": 7, "scale": 0}]}}}]})");
    const CommandResult explained =
        command({"run", "look.json", "in_0001.exr", "-o", "out.exr", "--explain"});
    EXPECT_NE(
        explained.out.find(
            R"(motion_blur.objects = {"default": {"scale": 1}, "rows": [{"object": 7, "scale": 0}]}   [the look])"),
        std::string::npos)
        << explained.out;
}

}  // namespace
}  // namespace aftershade::test
