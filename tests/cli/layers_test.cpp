// Captures that know what lies behind, through the command.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "framework/batch/process_codes.h"
#include "framework/file/exr_file.h"
#include "tests/cli/command.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A lamp 2 m wide, 5 m before a wall of another light that fills the picture.
constexpr const char* kScene = R"({ "aftershade": 1, "size": [32, 18], "frames": "1-2",
    "camera": { "position": [0, 0, 10], "focal_length": 18, "sensor_width": 36 },
    "materials": { "near": { "albedo": 0, "specular": 0, "emission": 0.25 },
                   "far": { "albedo": 0, "specular": 0, "emission": 2 } },
    "objects": [ { "id": 1, "shape": "plane", "size": [2, 2], "material": "near" },
                 { "id": 2, "shape": "plane", "size": [100, 100], "position": [0, 0, -5], "material": "far" } ] })";
constexpr const char* kManifest =
    R"({ "aftershade": 1, "id": "reveal", "version": "1.0.0", "summary": "Shows layer 1.",
    "inputs": { "color": { "role": "color", "doc": "Light." },
                "behind": { "role": "color", "optional": true, "layer": 1, "doc": "Behind it." } },
    "outputs": { "color": { "role": "color", "doc": "Light." } },
    "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color", "behind"], "writes": ["color"] } ] })";
constexpr const char* kShader = R"(#version 450 core
#include <pass>
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    out_color = texelFetch(color, p, 0);
#ifdef HAS_BEHIND
    vec4 hidden = texelFetch(behind, p, 0);
    if (hidden.a > 0.0) out_color = hidden;
#endif
}
)";

class CapturesWithLayers : public testing::Test {
protected:
    CapturesWithLayers() {
        write_text(folder_ / "scene.json", kScene);
        fs::create_directories(folder_ / "effects/reveal");
        write_text(folder_ / "effects/reveal/effect.json", kManifest);
        write_text(folder_ / "effects/reveal/main.frag", kShader);
        write_text(folder_ / "reveal.json", R"({"aftershade": 1, "steps": [{"effect": "reveal"}]})");
    }
    CommandResult command(std::vector<std::string> arguments, int exit_code = 0) {
        CommandResult result = run_aftershade(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
        return result;
    }
    /// Red in the middle, where the lamp is, and at the left, where it is not.
    std::pair<float, float> rendered(const std::string& look, const std::string& capture) {
        command({"run", look, capture, "--effect-path", "effects", "--frames", "1", "-o", "out.exr",
                 "--pixel-type", "float", "--backend", "software"});
        const Image out = ExrFile(folder_ / "out.exr").read_floats(0, std::vector<std::string>{"R"});
        return {out.at(16, 9, 0), out.at(1, 9, 0)};
    }
    TemporaryFolder folder_;
};

TEST_F(CapturesWithLayers, ShowWhatIsHiddenToEffectsThatAskForIt) {
    command({"render", "scene.json", "-o", "layers", "--layers", "2"});
    command({"render", "scene.json", "-o", "plain"});
    command({"render", "scene.json", "-o", "deep", "--deep"});
    // Behind the lamp is the wall; behind the wall the background, which is black.
    EXPECT_EQ(rendered("reveal.json", "layers"), std::pair(2.0f, 0.0f));
    EXPECT_EQ(rendered("reveal.json", "plain"), std::pair(0.25f, 2.0f));
    EXPECT_EQ(rendered("reveal.json", "deep"), std::pair(2.0f, 0.0f));
    write_text(folder_ / "none.json", R"({"aftershade": 1, "steps": [{"effect": "sanitize"}]})");
    EXPECT_EQ(rendered("none.json", "layers"), std::pair(0.25f, 2.0f));
    EXPECT_EQ(rendered("none.json", "deep"), std::pair(0.25f, 2.0f));
    // What the first layer has is what is written without layers, bit for bit.
    EXPECT_EQ(read_text(folder_ / "layers/gbuffer_0001.exr"), read_text(folder_ / "plain/gbuffer_0001.exr"));
}

TEST_F(CapturesWithLayers, DrawAWarningWhereColorChangesBeforeTheyAreRead) {
    command({"render", "scene.json", "-o", "layers", "--layers", "2", "--frames", "1"});
    command({"render", "scene.json", "-o", "plain", "--frames", "1"});
    const auto warning = [&](const std::string& steps, const std::string& capture) {
        write_text(folder_ / "look.json", R"({"aftershade": 1, "steps": [)" + steps + "]}");
        return command({"run", "look.json", capture, "--effect-path", "effects", "-o", "out.exr", "--backend",
                        "software", "--overwrite", "--progress", "none"})
            .err;
    };
    const std::string grade = R"({"effect": "color_grade"})", reveal = R"({"effect": "reveal"})";
    EXPECT_EQ(
        warning(grade + "," + reveal, "layers"),
        "aftershade: warning: step 'reveal' reads the capture's layers, and 'color_grade' before it changed "
        "the picture's color alone; move what changes light behind 'reveal'\n");
    EXPECT_EQ(warning(reveal + "," + grade, "layers"), "");
    const std::string wired = R"({"effect": "reveal", "in": {"color": "capture.color"}})";
    EXPECT_EQ(warning(grade + "," + wired, "layers"), "");
    EXPECT_EQ(warning(grade + "," + reveal, "plain"), "");
}

TEST_F(CapturesWithLayers, KeepTheChannelsOfADeepFileFlatAndThoseOfSeveralFilesNot) {
    command({"render", "scene.json", "-o", "layers", "--layers", "2", "--frames", "1"});
    command({"render", "scene.json", "-o", "deep", "--deep", "--frames", "1"});
    write_text(folder_ / "none.json", R"({"aftershade": 1, "steps": [{"effect": "sanitize"}]})");
    const std::vector<std::string> keep = {"--keep-channels", "--backend", "software", "-o", "kept.exr"};
    const auto run = [&](const std::string& capture, int exit_code) {
        std::vector<std::string> words = {"run", "none.json", capture};
        words.insert(words.end(), keep.begin(), keep.end());
        return command(words, exit_code).err;
    };
    EXPECT_NE(run("layers", int(ExitCode::usage)).find("the capture's 2 layers are several pictures"),
              std::string::npos);
    run("deep", 0);
    const ExrFile kept(folder_ / "kept.exr");
    EXPECT_EQ(kept.parts()[0].type, "scanlineimage");
    EXPECT_EQ(kept.read_floats(0, std::vector<std::string>{"Z"}).at(16, 9, 0), 10);
    EXPECT_EQ(kept.read_uints(0, std::vector<std::string>{"object_id.I"}).uint_at(1, 9, 0), 2u);
}

TEST_F(CapturesWithLayers, AreShownByInspect) {
    command({"render", "scene.json", "-o", "deep", "--deep", "--frames", "1"});
    const json deep = json::parse(command({"inspect", "deep", "--pixel", "16,9", "--json"}).out);
    EXPECT_EQ(deep["layer_count"], 4);
    // The lamp, the wall and the background; elsewhere two of them.
    std::uint64_t pixels = 0;
    for (const json& count : deep["parts"][0]["samples"]) pixels += count["pixels"].get<std::uint64_t>();
    EXPECT_EQ(pixels, 32u * 18);
    EXPECT_EQ(deep["parts"][0]["samples"][1]["pixels"], 0);
    EXPECT_GT(deep["parts"][0]["samples"][2]["pixels"], 400);
    const json& at = deep["pixel"]["parts"][0];
    ASSERT_EQ(at["samples"].size(), 3);
    const auto value = [&](std::size_t sample, const char* channel) {
        const auto names = at["channels"].get<std::vector<std::string>>();
        return at["samples"][sample][std::size_t(std::ranges::find(names, channel) - names.begin())]
            .get<double>();
    };
    EXPECT_EQ(value(0, "Z"), 10);
    EXPECT_EQ(value(0, "A"), 1);
    EXPECT_EQ(value(1, "R"), 2);
    EXPECT_EQ(value(1, "object_id.I"), 2);
    EXPECT_NE(deep["notes"].dump().find("are reduced to 4 layers: 0 % of these pixels have more gaps"),
              std::string::npos)
        << deep["notes"];
    const std::string text = command({"inspect", "deep", "--pixel", "99,9"}).out;
    EXPECT_NE(text.find("layers, front to back: 4\n"), std::string::npos) << text;
    EXPECT_NE(text.find("samples in a pixel\n"), std::string::npos) << text;
    EXPECT_NE(text.find("pixel (99, 9)\n    outside of the data window"), std::string::npos) << text;
}

TEST_F(CapturesWithLayers, AreRenderedAgainWhereALayerChanged) {
    command({"render", "scene.json", "-o", "layers", "--layers", "2"});
    const std::vector<std::string> run = {"run", "reveal.json",  "layers",   "--effect-path", "effects",
                                          "-o",  "out_####.exr", "--resume", "--backend",     "software"};
    command(run);
    const auto before = fs::last_write_time(folder_ / "out_0001.exr");
    fs::copy_file(folder_ / "layers/gbuffer_0002.exr", folder_ / "layers/layer1_0002.exr",
                  fs::copy_options::overwrite_existing);
    const CommandResult again = command(run);
    const Image out = ExrFile(folder_ / "out_0002.exr").read_floats(0, std::vector<std::string>{"R"});
    EXPECT_EQ(out.at(16, 9, 0), 0.25f);
    EXPECT_EQ(fs::last_write_time(folder_ / "out_0001.exr"), before);
    // A layer that is not there is a frame that is not there.
    fs::remove(folder_ / "layers/layer1_0001.exr");
    EXPECT_NE(command({"run", "reveal.json", "layers", "--effect-path", "effects", "-o", "none_####.exr",
                       "--backend", "software"},
                      int(ExitCode::partial))
                  .err.find("layer1_0001.exr"),
              std::string::npos);
}

TEST_F(CapturesWithLayers, AreNamedWhereEffectsAreDescribed) {
    const std::string text = command({"describe", "reveal", "--effect-path", "effects"}).out;
    EXPECT_NE(text.find("color, optional, of layer 1"), std::string::npos) << text;
    const json document =
        json::parse(command({"describe", "reveal", "--effect-path", "effects", "--json"}).out);
    EXPECT_EQ(document["inputs"]["behind"]["layer"], 1);
    const CommandResult checked =
        command({"check", "reveal", "--effect-path", "effects", "--backend", "software"});
    EXPECT_EQ(checked.out, "reveal: 0 errors, 0 warnings\n");
}

}  // namespace
}  // namespace aftershade::test
