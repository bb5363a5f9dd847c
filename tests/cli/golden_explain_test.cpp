#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <vector>

#include "framework/base/cores.h"
#include "framework/golden/approved_image.h"
#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGit = "/usr/bin/git";

/// A case of five steps in a repository that also has the effects, modules and profiles that it uses.
class GoldenExplain : public GoldenCommand {
protected:
    void SetUp() override {
        if (!fs::exists(kGit)) GTEST_SKIP() << "git is absent (Debian package git)";
        fs::create_directories(folder_ / "data");
        for (const char* part : {"effects", "glsl", "profiles", "looks", "page"})
            fs::copy(fs::path(AFTERSHADE_SOURCE_DIR) / part, folder_ / "data" / part,
                     fs::copy_options::recursive);
        write_text(folder_ / "look.json", kLook);
        write_text(folder_ / "capture.json",
                   R"({ "aftershade": 1, "frames": "in_####.exr", "profile": "native",
            "camera": { "focal_length": "50 mm", "sensor_width": "36 mm" } })");
        write_text(folder_ / "golden.json", kSuite);
        git({"init", "-q", "."});
        commit("The scene");
        ASSERT_EQ(suite({"approve"}).exit_code, 0);
        commit("Approve the case");
    }

    static constexpr const char* kLook = R"({ "aftershade": 1, "steps": [
        { "effect": "color_grade", "params": { "exposure": 0.5, "temperature": 5000, "saturation": 1.2 } },
        { "effect": "bokeh", "params": { "f_number": 0.5, "focus_distance": "2 m" } },
        { "effect": "bloom", "params": { "intensity": 0.3 } },
        { "effect": "vignette", "params": { "natural": 1 } },
        { "effect": "sharpen" } ] })";
    static constexpr const char* kSuite =
        R"({ "aftershade": 1, "cases": [ { "name": "film", "look": "look.json",
        "capture": "capture.json", "frames": "1" } ] })";

    CommandResult git(std::vector<std::string> words) {
        words.insert(words.begin(), {kGit, "-c", "user.name=Ada", "-c", "user.email=ada@example.com"});
        return Command(words, folder_.path()).wait();
    }
    void commit(const std::string& subject) {
        git({"add", "-A"});
        ASSERT_EQ(git({"commit", "-q", "-m", subject}).exit_code, 0);
    }
    CommandResult suite(std::vector<std::string> words, Environment environment = {}) {
        words.insert(words.begin() + 1, "golden.json");
        environment["AFTERSHADE_DATA"] = (folder_ / "data").string();
        environment["AFTERSHADE_CACHE"] = "off";
        return golden(words, environment);
    }
    CommandResult explain(const Environment& environment = {}) {
        return suite({"explain", "film"}, environment);
    }
    void replace(const std::string& file, const std::string& from, const std::string& to) {
        std::string text = read_text(folder_ / file);
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << file << ": " << from;
        write_text(folder_ / file, text.replace(at, from.size(), to));
    }
    void write_scene(float point, float depth_m) {
        SyntheticScene scene{
            .width = 64, .height = 36, .background = {0.18f, 0.5f, 0.02f}, .background_depth_m = depth_m};
        scene.sphere = SyntheticSphere{20, 15, 9, 2};
        scene.points = {{50, 8, point}};
        write_capture(make_capture(scene, 1), folder_ / "in_0001.exr");
    }
};

/// What is done to the scene, and what must be named.
struct Plant {
    std::string file, from, to;
    std::string step, cause;
};

TEST_F(GoldenExplain, NamesStepCauseAndCommitOfPlantedChanges) {
    const std::vector<Plant> plants = {
        {"look.json", R"("exposure": 0.5)", R"("exposure": 0.6)", "color_grade",
         "parameter color_grade.exposure is 0.6, was 0.5"},
        {"look.json", R"("f_number": 0.5)", R"("f_number": 0.8)", "bokeh",
         "parameter bokeh.f_number is 0.8, was 0.5"},
        {"look.json", R"("intensity": 0.3)", R"("intensity": 0.3, "radius": 20)", "bloom",
         "parameter bloom.radius is 20, was not set"},
        {"look.json", R"("params": { "natural": 1 })", R"("preset": "dramatic")", "vignette",
         "parameter vignette.strength is 0.8, was not set"},
        {"look.json", R"("params": { "natural": 1 })", R"("params": { "natural": 1 }, "mix": 0.5)",
         "vignette", "parameter vignette.mix is 0.5, was not set"},
        {"golden.json", R"("frames": "1")", R"("frames": "1", "set": ["sharpen.amount=0.9"])", "sharpen",
         "parameter sharpen.amount is 0.9, was not set"},
        {"data/effects/color_grade/grade.frag", "exp2(param.exposure)", "exp2(param.exposure + 0.1)",
         "color_grade", "shader effects/color_grade/grade.frag has changed"},
        {"data/effects/bloom/tent.glsl", "low_weight.y * upper", "0.9 * low_weight.y * upper", "bloom",
         "shader effects/bloom/tent.glsl has changed"},
        {"data/effects/vignette/vignette.frag", "1.0 - param.strength", "1.0 - 0.5 * param.strength",
         "vignette", "shader effects/vignette/vignette.frag has changed"},
        {"data/glsl/luminance.glsl", "0.2126", "0.3126", "color_grade",
         "shader glsl/luminance.glsl has changed"},
        {"data/effects/vignette/effect.json", R"("default": 0.3)", R"("default": 0.4)", "vignette",
         "manifest effects/vignette/effect.json has changed"},
        {"data/glsl/lens/coc.glsl", "return 0.5 * aperture", "return 0.4 * aperture", "bokeh",
         "module glsl/lens/coc.glsl has changed"},
        {"data/glsl/lens/module.json",
         R"("max_coc_radius": { "type": "float", "advanced": true, "unit": "px", "default": 64)",
         R"("max_coc_radius": { "type": "float", "advanced": true, "unit": "px", "default": 1)", "bokeh",
         "module glsl/lens/module.json has changed"},
        {"data/glsl/lens/packing.glsl", "return Light(vec4(uintBitsToFloat(texel.xyz)",
         "return Light(vec4(0.5 * uintBitsToFloat(texel.xyz)", "bokeh",
         "module glsl/lens/packing.glsl has changed"},
        {"capture.json", R"("50 mm")", R"("35 mm")", "bokeh", "capture capture.json has changed"},
        {"data/profiles/native.json", R"("channels": ["R", "G", "B", "A?"])",
         R"("channels": ["G", "R", "B", "A?"])", "color_grade", "profile profiles/native.json has changed"},
        {"data/profiles/native.json", R"("depth": { "channels": ["Z"])",
         R"("depth": { "channels": ["position.X"])", "bokeh", "profile profiles/native.json has changed"}};
    for (const Plant& plant : plants) {
        SCOPED_TRACE(plant.file + ": " + plant.to);
        replace(plant.file, plant.from, plant.to);
        const std::string subject = "Plant " + plant.cause;
        commit(subject);
        const CommandResult result = explain();
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.out.find("first step that differs: '" + plant.step + "'"), std::string::npos)
            << result.out;
        const std::size_t cause = result.out.find("  cause: " + plant.cause + "\n");
        ASSERT_NE(cause, std::string::npos) << result.out;
        EXPECT_NE(result.out.find(" Ada: " + subject + "\n", cause), std::string::npos) << result.out;
        ASSERT_EQ(git({"reset", "-q", "--hard", "HEAD~1"}).exit_code, 0);
    }
}

TEST_F(GoldenExplain, NamesTheFileOfTheCaptureAndTheStepThatReadsIt) {
    write_scene(90, 6);
    const CommandResult light = explain();
    EXPECT_NE(light.out.find("first step that differs: 'color_grade'"), std::string::npos) << light.out;
    EXPECT_NE(light.out.find("cause: capture in_0001.exr has changed\n    not committed\n"),
              std::string::npos)
        << light.out;
    write_scene(30, 3);
    const CommandResult depth = explain();
    EXPECT_NE(depth.out.find("first step that differs: 'bokeh' (effect bokeh), output color, frame 1; 1 step "
                             "before it gave the approved bits\n"),
              std::string::npos)
        << depth.out;
    EXPECT_NE(depth.out.find("cause: capture in_0001.exr has changed\n"), std::string::npos) << depth.out;
}

TEST_F(GoldenExplain, NamesTheDriverWhereOnlyTheMachineDiffers) {
    const CommandResult processor = explain({{"GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1"}});
    if (cpu_instructions() == "x86-64 with FMA" &&
        processor.out.find("every image has the approved bits") == std::string::npos) {
        EXPECT_EQ(processor.exit_code, 0) << processor.err;
        EXPECT_NE(processor.out.find("cause: the machine: the processor is x86-64 without FMA instead of "
                                     "x86-64 with FMA\n"),
                  std::string::npos)
            << processor.out;
    }
    const fs::path sidecar = sidecar_path(image("film.color.0001"));
    Json json = Json::parse(read_text(sidecar));
    json["version"] = "4.5 (Core Profile) Mesa 21.0.0";
    change_image(image("film.color.0001"), [](Image& pixels) { pixels.at(3, 3, 0) *= 1.01f; });
    json["image_hash"] = file_hash(image("film.color.0001"));
    write_text(sidecar, json.dump());
    const CommandResult driver = explain();
    EXPECT_EQ(driver.exit_code, 0) << driver.err;
    EXPECT_NE(driver.out.find(" instead of 21.0.0\n"), std::string::npos) << driver.out;
    EXPECT_NE(driver.out.find("cause: the machine: Mesa "), std::string::npos) << driver.out;
    replace("look.json", R"("intensity": 0.3)", R"("intensity": 0.4)");
    const CommandResult both = explain();
    EXPECT_NE(both.out.find("first step that something has changed of: 'bloom'"), std::string::npos)
        << both.out;
    EXPECT_NE(both.out.find("cause: parameter bloom.intensity is 0.4, was 0.3\n"), std::string::npos)
        << both.out;
}

TEST_F(GoldenExplain, SeparatesWhatHasChangedOfOtherSteps) {
    replace("look.json", R"("f_number": 0.5)", R"("f_number": 0.8)");
    replace("data/effects/vignette/vignette.frag", "1.0 - param.strength", "1.0 - 0.5 * param.strength");
    const CommandResult result = explain();
    EXPECT_NE(result.out.find("cause: parameter bokeh.f_number is 0.8, was 0.5\n"), std::string::npos);
    EXPECT_NE(result.out.find("also changed, of other steps: shader effects/vignette/vignette.frag"),
              std::string::npos)
        << result.out;
}

TEST_F(GoldenExplain, NamesWhatHasChangedOfACaseThatDoesNotRender) {
    replace("data/effects/bloom/tent.glsl", "return ", "retur ");
    const CommandResult result = explain();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("first step that something has changed of: 'bloom'"), std::string::npos)
        << result.out;
    EXPECT_NE(result.out.find("cause: shader effects/bloom/tent.glsl has changed\n    not committed\n"),
              std::string::npos)
        << result.out;
}

TEST_F(GoldenExplain, NamesNoCommitThatAShallowCloneCannotTell) {
    replace("look.json", R"("exposure": 0.5)", R"("exposure": 0.6)");
    commit("Brighter");
    write_text(folder_ / "unrelated", "x");
    commit("Unrelated");
    EXPECT_NE(explain().out.find(" Ada: Brighter\n"), std::string::npos);
    const TemporaryFolder clone;
    const std::string url = "file://" + folder_.path().string();
    ASSERT_EQ(git({"clone", "-q", "--depth", "1", url, (clone / "c").string()}).exit_code, 0);
    const CommandResult result = run_aftershade(
        {"golden", "explain", "golden.json", "film"}, clone / "c",
        {{"AFTERSHADE_DATA", (folder_ / "data").string()}, {"AFTERSHADE_BACKEND", "software"}});
    EXPECT_NE(
        result.out.find("cause: parameter color_grade.exposure is 0.6, was 0.5\n    in a commit that this "
                        "shallow clone lacks (git fetch --unshallow)\n"),
        std::string::npos)
        << result.out;
}

TEST_F(GoldenExplain, SaysWhatItCannotFindOut) {
    EXPECT_EQ(explain().out, "film: every image has the approved bits\n");
    const CommandResult unknown = suite({"explain", "flim"});
    EXPECT_EQ(unknown.exit_code, 64);
    EXPECT_NE(unknown.err.find("case flim: error: matches no case's name or tag; did you mean 'film'?"),
              std::string::npos)
        << unknown.err;
    // A sidecar of an earlier version has hashes of the whole look and capture alone.
    const fs::path sidecar = sidecar_path(image("film.color.0001"));
    Json json = Json::parse(read_text(sidecar));
    for (const char* key : {"files", "values", "steps"}) json.erase(key);
    write_text(sidecar, json.dump());
    EXPECT_EQ(run().exit_code, 0) << "an old sidecar stays valid";
    replace("look.json", R"("intensity": 0.3)", R"("intensity": 0.4)");
    const CommandResult old = explain();
    EXPECT_EQ(old.exit_code, 0) << old.err;
    EXPECT_NE(old.out.find("cause: the look or an effect has changed since it was approved\n"),
              std::string::npos)
        << old.out;
    EXPECT_NE(old.out.find("golden approve --renew-sidecars"), std::string::npos) << old.out;
}

}  // namespace
}  // namespace aftershade::test
