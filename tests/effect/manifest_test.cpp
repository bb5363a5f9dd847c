#include "framework/effect/manifest/manifest.h"

#include <algorithm>

#include "tests/effect/effect_folder.h"

namespace aftershade {
namespace {

using test::demo_manifest;
using test::EffectFolder;
using test::faults_of_manifest;
using test::Lines;

TEST(Manifest, KeepsAllThatItSays) {
    const EffectFolder folder;
    const EffectManifest manifest = folder.sound_manifest();
    EXPECT_EQ(manifest.id, "demo");
    EXPECT_EQ(manifest.version, "1.0.0");
    EXPECT_EQ(manifest.summary, "A demo.");
    EXPECT_EQ(manifest.folder, folder.path());
    ASSERT_EQ(manifest.inputs.size(), 2U);
    EXPECT_FALSE(manifest.find_input("color")->optional);
    EXPECT_TRUE(manifest.find_input("depth")->optional);
    EXPECT_EQ(manifest.find_output("color")->role, "color");
    EXPECT_EQ(manifest.find_output("depth"), nullptr);
    EXPECT_EQ(manifest.param_names(), (std::vector<std::string>{"gain", "mode", "flag", "taps"}));
    EXPECT_EQ(manifest.find_texture("small")->format, gpu::TextureFormat::rgba16f);
    EXPECT_EQ(manifest.find_texture("small")->grid.scale, 0.5);
    ASSERT_EQ(manifest.passes.size(), 2U);
    EXPECT_EQ(manifest.passes[1].shader, "b.frag");
    EXPECT_EQ(manifest.passes[1].reads[0].name, "color");
    EXPECT_EQ(manifest.passes[1].reads[0].filter, gpu::Filter::linear);
    EXPECT_EQ(manifest.passes[1].reads[1].filter, gpu::Filter::nearest);
    EXPECT_EQ(manifest.passes[1].reads[1].wrap, gpu::Wrap::clamp);
    ASSERT_EQ(manifest.passes[1].writes.size(), 1U);
    EXPECT_EQ(manifest.passes[1].writes[0].name, "color");
    const PresetSpec* preset = manifest.find_preset("strong");
    ASSERT_NE(preset, nullptr);
    EXPECT_EQ(preset->values.at("gain"), ParamValue(2.0));
    EXPECT_EQ(preset->values.at("mode"), ParamValue(std::string("good")));
}

TEST(Manifest, ReadsFiltersDefinesAndConditions) {
    const EffectFolder folder(demo_manifest({{test::kPasses, R"("passes": [
        {"name": "one", "shader": "a.frag", "reads": [{"color": {"filter": "linear", "outside": "weight_zero"}},
         "depth"], "writes": ["small"], "defines": {"STEPS": 4, "SIDE": "left"},
         "when": {"mode": ["fast", "good"], "flag": true, "taps": 3, "has.depth": false}},
        {"name": "two", "shader": "b.frag", "reads": [{"small": "nearest"}], "writes": ["color"]}])"}}));
    const EffectManifest manifest = folder.sound_manifest();
    const PassSpec& pass = manifest.passes.at(0);
    EXPECT_EQ(pass.reads[0].filter, gpu::Filter::linear);
    EXPECT_EQ(pass.reads[0].wrap, gpu::Wrap::zero);
    EXPECT_EQ(pass.defines, (std::map<std::string, std::string>{{"SIDE", "left"}, {"STEPS", "4"}}));
    ASSERT_EQ(pass.when.size(), 4U);
    EXPECT_EQ(pass.when[0].values, (std::vector<ParamValue>{std::string("fast"), std::string("good")}));
    EXPECT_EQ(pass.when[1].values, std::vector<ParamValue>{true});
    EXPECT_EQ(pass.when[2].values, std::vector<ParamValue>{std::int64_t(3)});
    EXPECT_EQ(pass.when[3].subject, "has.depth");
}

struct Broken {
    int section;  ///< and so the line
    std::string text;
    Lines messages;
};

const std::vector<Broken> kBrokenSections = {
    {test::kHead,
     R"("aftershade": 2, "id": "demo", "version": "1.0.0", "summary": ".")",
     {"1: document version 2 is not known; this program reads version 1"}},
    {test::kHead,
     R"("aftershade": 1, "id": "dem", "version": "1.0.0", "summary": ".")",
     {"1: the id 'dem' is not the name of its folder, 'demo'"}},
    {test::kHead,
     R"("aftershade": 1, "id": "Demo.1", "version": "1.0.0", "summary": ".")",
     {"1: the id 'Demo.1' is not the name of its folder, 'demo'",
      "1: the id 'Demo.1' must be snake_case: a-z, 0-9 and _, beginning with a letter"}},
    {test::kHead,
     R"("aftershade": 1, "id": "", "version": "1.0.0", "summary": ".")",
     {"1: the id '' is not the name of its folder, 'demo'",
      "1: the id '' must be snake_case: a-z, 0-9 and _, beginning with a letter"}},
    {test::kHead,
     R"("aftershade": 1, "id": "demo", "sumary": ".")",
     {"1: the manifest has no 'version'", "1: the manifest has no 'summary'",
      "1: the manifest has no key 'sumary'; did you mean 'summary'?"}},
    {test::kInputs,
     R"("inputs": {"color": {"role": "colour"}, "depth": {"role": "depth"}})",
     {"2: 'colour' is not a role; did you mean 'color'?"}},
    {test::kInputs,
     R"("inputs": {"color": {"role": "color"}, "depth": {"optional": 1}})",
     {"2: input 'depth' has no 'role'", "2: 'optional' must be true or false, not an integer"}},
    {test::kInputs,
     R"("inputs": {"color": {"role": "color"}, "depth": {"role": "depth"}, "mask": {"role": "mask"}})",
     {"2: no pass reads the input 'mask'"}},
    {test::kInputs,
     R"("inputs": {"color": {"role": "color"}, "depth": {"role": "depth"}, "Mask": "mask"})",
     {"2: input 'Mask' must be snake_case: a-z, 0-9 and _, beginning with a letter",
      "2: input 'Mask' must be an object, not a string"}},
    {test::kInputs,
     R"("inputs": {"color": {"role": "color", "when": {"mode": "god"}}, "depth": {"role": "depth",
        "optional": true, "when": {"has.depth": true, "mde": "fast"}}})",
     {"2: an input with 'when' must be 'optional'", "2: \"god\" is not a value of 'mode'",
      "2: only passes test whether an input is present, a number is not 0 or a parameter changes the image; "
      "the conditions of an input are on values of parameters",
      "2: the condition 'mde' is not a parameter; did you mean 'mode'?"}},
    {test::kInputs,
     R"("inputs": {"color": {"role": "color", "instead": "depth"}, "depth": {"role": "depth", "optional": true,
        "instead": "color"}})",
     {"2: an input with 'instead' must be 'optional': one without it is always there",
      "2: input 'depth': 'instead' names 'color', which is not another optional input"}},
    {test::kOutputs,
     R"("outputs": {})",
     {"3: the effect has no outputs",
      "6: pass 'two': writes 'color', which is neither an output nor a texture"}},
    {test::kOutputs,
     R"("outputs": {"color": {"role": "color"}, "display": {"role": "display"}})",
     {"3: no pass writes the output 'display'"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "rgba61f", "doc": "."}})",
     {"5: 'format' is 'rgba61f' but must be 'r8', 'rg8', 'rgba8', 'r16f', 'rg16f', 'rgba16f', 'r32f', "
      "'rg32f', "
      "'rgba32f', 'r32ui', 'rg32ui', 'rgba32ui' or 'r32i'; did you mean 'rgba16f'?"}},
    {test::kTextures, R"("textures": {"small": {"format": "r8"}})", {"5: texture 'small' has no 'doc'"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "r8", "scale": 0, "doc": "."}})",
     {"5: 'scale' must be above 0 and at most 4, not 0"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "r8", "tile": 1, "doc": "."}})",
     {"5: 'tile' must be from 2 to 4096, not 1"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "r8", "tile": 8, "scale": 1, "doc": "."}})",
     {"5: only one of 'scale', 'tile' and 'size' may be given"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "r8", "tile": 8, "room": [0, 0.5], "doc": "."}})",
     {"5: only one of 'room' and 'tile' may be given"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "r8", "room": [0.5], "doc": "."}})",
     {"5: 'room' holds 2 numbers"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "r8", "room": [0, 2], "doc": "."}})",
     {"5: 'room' must be from 0 to 1, not 2"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "r8", "doc": "."}, "spare": {"format": "r8", "doc": "."}})",
     {"5: no pass writes the texture 'spare'"}},
    {test::kTextures,
     R"("textures": {"small": {"format": "r8", "doc": "."}, "color": {"format": "r8", "doc": "."}})",
     {"5: texture 'color' needs the GLSL name 'color', which the input 'color' has",
      "5: texture 'color' needs the GLSL name 'out_color', which the output 'color' has"}},
    {test::kParams,
     R"("params": {"gain": {"type": "float", "default": 1, "doc": "."},
      "mode": {"type": "int", "default": 0.5, "doc": "."}})",
     {"4: mode.default: 0.5 is not a whole number",
      "7: preset strong, gain: '2 m' has a unit, but this is a pure number"}},
    {test::kParams,
     R"("params": {"gain": {"type": "float", "unit": "m", "default": 1,
      "from": "camera.focus_distanc", "doc": "."},
      "mode": {"type": "enum", "values": ["good", "bad"], "default": "bad", "doc": "."}})",
     {"4: 'camera.focus_distanc' is not a value of the capture; did you mean 'camera.focus_distance'?"}},
    {test::kPresets,
     R"("presets": {"strong": {"gian": 2}})",
     {"7: preset 'strong' sets 'gian', which is not a parameter; did you mean 'gain'?"}},
    {test::kPresets,
     R"("presets": {"strong": {"gain": 10, "mode": "goood"}})",
     {"7: preset strong, gain: 10 m is above the maximum 9 m",
      "7: preset strong, mode: 'goood' is not one of 'fast' or 'good'; did you mean 'good'?"}},
    {test::kPresets, R"("presets": {"strong": 5})", {"7: preset 'strong' must be an object, not an integer"}},
    {test::kPresets,
     R"("presets": {}, "pases": [])",
     {"7: the manifest has no key 'pases'; did you mean 'passes'?"}},
    {test::kMore, R"("uses": "lights")", {"8: 'uses' must be an array, not a string"}},
    {test::kMore,
     R"("uses": ["ligths", 3, "lights", "lights"])",
     {"8: 'ligths' is not a block that shaders can use; did you mean 'lights'?",
      "8: 'uses' holds 'lights' twice", "8: 'uses' holds strings, not an integer"}},
    {test::kMore,
     R"("uses": ["lights"], "buffers": {"lights": {"element": "uint", "count": 4, "clear": 0, "doc": "."}})",
     {"8: buffer 'lights' needs the GLSL name 'lights', which the block 'lights' has",
      "8: no pass uses the buffer 'lights'"}},
};

// The text after the known values of the capture changes with the camera's fields; the beginning tells the
// fault.
bool fits(const Lines& messages, const Lines& beginnings) {
    if (messages.size() != beginnings.size()) return false;
    for (std::size_t i = 0; i < messages.size(); ++i)
        if (!messages[i].starts_with(beginnings[i])) return false;
    return true;
}

TEST(Manifest, SaysWhatIsWrongInASectionAtItsLine) {
    for (const Broken& broken : kBrokenSections) {
        Lines lines = faults_of_manifest(demo_manifest({{broken.section, broken.text}}));
        std::sort(lines.begin(), lines.end());
        Lines expected = broken.messages;
        std::sort(expected.begin(), expected.end());
        EXPECT_TRUE(fits(lines, expected)) << broken.text << "\n" << ::testing::PrintToString(lines);
    }
}

/// What the second of two passes says; the first writes "small" out of color and depth.
Lines faults_of_second_pass(const std::string& pass) {
    return faults_of_manifest(demo_manifest({{test::kPasses, R"("passes": [
        {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"]}, )" +
                                                                 pass + "]"}}));
}

struct BrokenPass {
    std::string pass;
    Lines messages;
};

const std::string kGoodPass =
    R"({"name": "two", "shader": "b.frag", "reads": ["small"], "writes": ["color"])";

const std::vector<BrokenPass> kBrokenPasses = {
    {kGoodPass + "}", {}},
    {R"({"name": "one", "shader": "b.frag", "writes": ["color"]})",
     {"6: pass 'one': another pass has this name"}},
    {R"({"name": "two", "shader": "none.frag", "writes": ["color"]})",
     {"6: pass 'two': no file 'none.frag' in "}},
    {R"({"name": "two", "shader": "../demo/a.frag", "writes": ["color"]})",
     {"6: pass 'two': 'shader' is a file name without folders"}},
    {R"({"shader": "b.frag", "writes": ["color"]})", {"6: the pass has no 'name'"}},
    {R"({"name": "two", "shader": "b.frag", "reads": ["small"]})",
     {"6: pass 'two': writes nothing", "3: no pass writes the output 'color'"}},
    {R"({"name": "two", "shader": "b.frag", "reads": ["dept"], "writes": ["color"]})",
     {"6: pass 'two': reads 'dept', which is neither an input nor a texture; did you mean 'depth'?"}},
    {R"({"name": "two", "shader": "b.frag", "writes": ["colour", "color"]})",
     {"6: pass 'two': writes 'colour', which is neither an output nor a texture; did you mean 'color'?"}},
    {R"({"name": "two", "shader": "b.frag", "reads": [{"depth": "linear"}], "writes": ["color"]})",
     {"6: pass 'two': 'depth' cannot be filtered linearly: its role is depth"}},
    {R"({"name": "two", "shader": "b.frag", "reads": [{"small": "cubic"}], "writes": ["color"]})",
     {"6: the filter of a read is 'nearest', 'linear' or 'pixel'"}},
    {R"({"name": "two", "shader": "b.frag", "reads": [{"small": {"outside": "no"}}], "writes": ["color"]})",
     {"6: 'outside' is 'no' but must be 'clamp' or 'weight_zero'"}},
    {R"({"name": "two", "shader": "b.frag", "reads": [["small"]], "writes": ["color"]})",
     {"6: a read is a name, or an object of one name with its filter: {\"color\": \"linear\"}"}},
    {R"({"name": "two", "shader": "b.frag", "reads": ["small", {"small": "linear"}], "writes": ["color"]})",
     {"6: pass 'two': reads 'small' twice"}},
    {R"({"name": "two", "shader": "b.frag", "writes": ["color", "color"]})",
     {"6: pass 'two': writes 'color' twice"}},
    {R"({"name": "two", "shader": "b.frag", "writes": ["color", "small"]})",
     {"6: pass 'two': writes 'color' and 'small', which differ in size"}},
    {R"({"name": "two", "shader": "b.frag", "reads": [{"color": "linear"}, {"small": "pixel"}],
         "writes": ["color"]})",
     {"6: pass 'two': reads 'small' by the pixel, but its target 'color' has another size"}},
    {kGoodPass + R"(, "when": {"mode": "god"}})", {"6: pass 'two': \"god\" is not a value of 'mode'"}},
    {kGoodPass + R"(, "when": {"mode": ["fast", true]}})", {"6: pass 'two': true is not a value of 'mode'"}},
    {kGoodPass + R"(, "when": {"flag": "yes"}})", {"6: pass 'two': \"yes\" is not a value of 'flag'"}},
    {kGoodPass + R"(, "when": {"gain": 1}})", {"6: pass 'two': 1 is not a value of 'gain'"}},
    {kGoodPass + R"(, "when": {"mde": "fast"}})",
     {"6: pass 'two': the condition 'mde' is not a parameter; did you mean 'mode'?"}},
    {kGoodPass + R"(, "when": {"has.color": true}})",
     {"6: pass 'two': 'has.color' does not name an optional input"}},
    {kGoodPass + R"(, "when": {"has.depth": "yes"}})",
     {"6: a condition on an input compares with true or false"}},
    {kGoodPass + R"(, "when": {"mode": []}})", {"6: a condition without a value never holds"}},
    {kGoodPass + R"(, "when": {"taps": 2.5}})",
     {"6: a condition compares with true, false, an integer or a name"}},
    {kGoodPass + R"(, "defines": {"A B": 1}})",
     {"6: 'A B' cannot name a define: letters, 0-9 and _ only; GLSL keeps GL_... and __ for itself"}},
    {kGoodPass + R"(, "defines": {"A": 1.5}})", {"6: a define is a string or an integer"}},
    {kGoodPass + R"(, "wehn": {}})", {"6: the pass has no key 'wehn'; did you mean 'when'?"}},
};

TEST(Manifest, SaysWhatIsWrongWithAPass) {
    for (const BrokenPass& broken : kBrokenPasses) {
        const Lines lines = faults_of_second_pass(broken.pass);
        EXPECT_TRUE(fits(lines, broken.messages)) << broken.pass << "\n" << ::testing::PrintToString(lines);
    }
}

TEST(Manifest, RefusesToReadWhatNoEarlierPassHasWritten) {
    const Lines swapped = faults_of_manifest(demo_manifest({{test::kPasses, R"("passes": [
        {"name": "two", "shader": "b.frag", "reads": ["small"], "writes": ["color"]},
        {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"]}])"}}));
    EXPECT_EQ(swapped, Lines{"6: pass 'two': reads 'small' before any pass has written it (write or clear it "
                             "in an earlier pass; with "
                             "\"history\": true, 'small.prev' is the previous frame's)"});
    const Lines itself = faults_of_manifest(demo_manifest({{test::kPasses, R"("passes": [
        {"name": "one", "shader": "a.frag", "reads": ["color", "depth", "small"], "writes": ["small"]},
        {"name": "two", "shader": "b.frag", "reads": ["small"], "writes": ["color"]}])"}}));
    EXPECT_EQ(itself, Lines{"6: pass 'one': reads 'small' before any pass has written it (write or clear it "
                            "in an earlier pass; with "
                            "\"history\": true, 'small.prev' is the previous frame's)"});
}

TEST(Manifest, RefusesToFilterIntegers) {
    const Lines lines = faults_of_manifest(
        demo_manifest({{test::kTextures, R"("textures": {"small": {"format": "r32ui", "doc": "."}})"},
                       {test::kPasses, R"("passes": [
        {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"]},
        {"name": "two", "shader": "b.frag", "reads": [{"small": "linear"}], "writes": ["color"]}])"}}));
    EXPECT_EQ(lines, Lines{"6: pass 'two': 'small' cannot be filtered linearly: its format is integer"});
}

TEST(Manifest, ListsTheFaultsOfAllSectionsAtOnce) {
    const Lines lines = faults_of_manifest(demo_manifest(
        {{test::kHead, R"("aftershade": 1, "id": "demo", "version": "1.0.0")"},
         {test::kInputs, R"("inputs": {"color": {"role": "color"}, "depth": {"role": "dpth"}})"},
         {test::kTextures, R"("textures": {"small": {"format": "rgba16f"}})"},
         {test::kPresets, R"("presets": {"strong": {"gain": -1}})"}}));
    EXPECT_EQ(
        lines,
        (Lines{"1: the manifest has no 'summary'", "2: 'dpth' is not a role; did you mean 'depth'?",
               "5: texture 'small' has no 'doc'", "7: preset strong, gain: -1 m is below the minimum 0 m"}));
}

TEST(Manifest, DoesNotRunOutOfStackOnALongText) {
    const std::string digits(300000, '1'), letters(300000, 'a');
    const auto head = [](const std::string& version) {
        return R"("aftershade": 1, "id": "demo", "summary": ".", "version": ")" + version + '"';
    };
    EXPECT_EQ(faults_of_manifest(demo_manifest({{test::kHead, head(digits + ".0.0")}})), Lines{});
    EXPECT_EQ(faults_of_manifest(demo_manifest({{test::kHead, head(digits)}})).size(), 1u);
    EXPECT_EQ(faults_of_second_pass(kGoodPass + R"(, "defines": {")" + letters + "\": 1}}"), Lines{});
    EXPECT_EQ(faults_of_second_pass(kGoodPass + R"(, "defines": {")" + letters + " \": 1}}").size(), 1u);
    EXPECT_EQ(faults_of_second_pass(
                  R"({"name": "two", "shader": "b.frag", "reads": [{"small": {"level": "pass.index + )" +
                  digits + R"("}}], "writes": ["color"]})"),
              Lines{R"(6: 'level' is an integer, "pass.index", "pass.index + 1" or "pass.index - 1")"});
}

TEST(Manifest, IsAnObject) {
    EXPECT_EQ(faults_of_manifest("[]"), Lines{"1: the manifest must be an object, not an array"});
}

}  // namespace
}  // namespace aftershade
