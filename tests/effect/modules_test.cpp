// What effects take from modules, sound and broken.
#include <gtest/gtest.h>

#include <regex>

#include "framework/effect/registry.h"
#include "framework/effect/shader_source.h"
#include "framework/effect/usage_check.h"
#include "tests/effect/effect_folder.h"

namespace aftershade {
namespace {

using test::demo_manifest;
using test::EffectFolder;
using test::Lines;

constexpr const char* kShaderHead = "#version 450 core\n#include <pass>\n";

/// The sections of a module.json, one a line in this order.
enum Part { kModuleHead = 1, kModuleParams, kModuleTextures, kModuleBuffers, kModulePasses, kModuleMore };

/// A module without faults, but for the parts that are replaced: the mean of `color` in a texture `tone`.
std::string tone_module(const std::map<int, std::string>& replaced = {}) {
    std::map<int, std::string> parts = {
        {kModuleHead, R"("aftershade": 1, "module": "tone", "summary": "The light's tone.")"},
        {kModuleParams,
         R"("params": {"key": {"type": "float", "default": 1, "min": 0, "max": 9, "doc": "."}})"},
        {kModuleTextures, R"("textures": {"tone": {"format": "r32f", "doc": "."}})"},
        {kModuleBuffers, R"("buffers": {"sums": {"element": "uint", "count": 4, "clear": 0, "doc": "."}})"},
        {kModulePasses, R"("passes": [{"name": "tone", "shader": "tone.frag", "reads": ["color"],
            "writes": ["tone"], "buffers": {"sums": "atomic"}}])"},
    };
    for (const auto& [part, text] : replaced) parts[part] = text;
    std::string text;
    for (auto& [part, section] : parts) {
        std::erase(section, '\n');
        text += (part == kModuleHead ? "{" : ",\n") + section;
    }
    return text + "}\n";
}

/// The demo effect beside a folder of modules that has `tone`.
class Modules : public testing::Test {
protected:
    Modules() {
        write_module("tone", tone_module());
        write("tone/tone.frag", std::string(kShaderHead) +
                                    "#include \"key.glsl\"\nvoid main() {\n    sums[0];\n"
                                    "    out_tone = keyed(texelFetch(color, ivec2(0), 0).r);\n}\n");
        write("tone/key.glsl", "float keyed(float tone) { return tone * param.key; }\n");
    }
    void write(const std::string& file, const std::string& text) const {
        std::filesystem::create_directories((glsl_ / file).parent_path());
        test::write_text(glsl_ / file, text);
    }
    void write_module(const std::string& name, const std::string& text) const {
        write(name + "/module.json", text);
    }

    /// Faults as printed, with the effect's folder as "demo" and that of modules as "glsl".
    Lines faults(std::optional<EffectManifest>* manifest = nullptr,
                 const std::string& modules = R"(["tone"])", test::Sections sections = {}) const {
        sections[test::kMore] = "\"modules\": " + modules;
        effect_.write("effect.json", demo_manifest(sections));
        Diagnostics diagnostics;
        const auto node = read_document(effect_.path() / "effect.json", diagnostics);
        const auto read = parse_manifest(*node, effect_.path(), diagnostics, glsl_.path());
        EXPECT_EQ(read.has_value(), !diagnostics.has_errors());
        if (manifest) *manifest = read;
        return shortened(diagnostics);
    }
    Lines faults_of_module(const std::map<int, std::string>& replaced) const {
        write_module("tone", tone_module(replaced));
        return faults();
    }
    EffectManifest sound(const std::string& modules = R"(["tone"])") const {
        std::optional<EffectManifest> manifest;
        EXPECT_EQ(faults(&manifest, modules), Lines{});
        return manifest.value_or(EffectManifest{});
    }
    Lines shortened(const Diagnostics& diagnostics) const {
        Lines lines = test::lines_of(diagnostics);
        for (std::string& line : lines)
            for (const auto& [path, name] :
                 {std::pair(effect_.path(), "demo"), std::pair(glsl_.path(), "glsl")})
                for (std::size_t at; (at = line.find(path.string())) != std::string::npos;)
                    line.replace(at, path.string().size(), name);
        // Columns are the parser's, not the module's.
        for (std::string& line : lines)
            line = std::regex_replace(line, std::regex(R"((\.json:\d+):\d+)"), "$1");
        return lines;
    }

    test::TemporaryFolder glsl_;
    EffectFolder effect_;
};

TEST_F(Modules, StandBeforeWhatTheEffectDeclares) {
    const EffectManifest manifest = sound();
    EXPECT_EQ(manifest.param_names(), (std::vector<std::string>{"key", "gain", "mode", "flag", "taps"}));
    ASSERT_EQ(manifest.textures.size(), 2U);
    EXPECT_EQ(manifest.textures[0].name, "tone");
    ASSERT_NE(manifest.find_buffer("sums"), nullptr);
    ASSERT_EQ(manifest.passes.size(), 3U);
    EXPECT_EQ(manifest.passes[0].name, "tone");
    EXPECT_EQ(manifest.passes[0].module, "tone");
    EXPECT_EQ(manifest.passes[0].folder, glsl_ / "tone");
    EXPECT_EQ(manifest.passes[0].place.file, (glsl_ / "tone/module.json").string());
    EXPECT_EQ(manifest.passes[1].module, "");
    EXPECT_EQ(manifest.passes[1].folder, effect_.path());
    ASSERT_EQ(manifest.modules.size(), 1U);
    EXPECT_EQ(manifest.modules[0].summary, "The light's tone.");
}

TEST_F(Modules, AreReadableByTheEffectAndSetByItsPresets) {
    std::optional<EffectManifest> manifest;
    EXPECT_EQ(faults(&manifest, R"(["tone"])",
                     {{test::kPasses, R"("passes": [
            {"name": "one", "shader": "a.frag", "reads": ["color", "depth", "tone"], "writes": ["small"]},
            {"name": "two", "shader": "b.frag", "reads": ["small"], "writes": ["color"], "when": {"mode": "good"}}])"},
                      {test::kPresets, R"("presets": {"strong": {"key": 3}})"}}),
              Lines{});
    EXPECT_EQ(manifest->find_preset("strong")->values.at("key"), ParamValue(3.0));
}

TEST_F(Modules, HaveTheirShadersInTheirOwnFolder) {
    effect_.write("tone.frag", "the effect's own is another file\n");
    const EffectManifest manifest = sound();
    ParamSet params;
    for (const ParamSpec& spec : manifest.params) params.set(spec.name, spec.default_value);
    Diagnostics diagnostics;
    const ShaderSource source =
        assemble_shader({&manifest, &manifest.passes[0], params, {}, glsl_.path()}, diagnostics);
    EXPECT_EQ(test::lines_of(diagnostics), Lines{});
    EXPECT_NE(source.text.find("return tone * param.key;"), std::string::npos);
    EXPECT_EQ(source.lines.back().file.text(), (glsl_ / "tone/tone.frag").string());
}

TEST_F(Modules, AreHeldToWhatTheyDeclare) {
    write_module(
        "tone",
        tone_module({{kModuleParams, R"("params": {"kye": {"type": "float", "default": 1, "doc": "."}})"}}));
    effect_.write("a.frag", std::string(kShaderHead) +
                                "void main() { color; depth; out_small = vec4(0); param.gain; MODE; }\n");
    effect_.write("b.frag",
                  std::string(kShaderHead) +
                      "void main() { color; small; out_color = vec4(0); param.flag; param.taps; }\n");
    const EffectManifest manifest = sound();
    Diagnostics diagnostics;
    check_declared_used(manifest, glsl_.path(), diagnostics);
    EXPECT_EQ(shortened(diagnostics), (Lines{"glsl/tone/key.glsl:1:41: error: 'param.key' is not a parameter "
                                             "of the effect; did you mean 'kye'?",
                                             "glsl/tone/module.json:2: error: no shader uses 'param.kye'"}));
}

TEST_F(Modules, MayHaveParametersOnlyAndBeMany) {
    write_module("hue", R"({"aftershade": 1, "module": "hue", "summary": ".",
        "params": {"hue": {"type": "angle", "default": 0, "doc": "."}}})");
    EXPECT_EQ(sound(R"(["hue", "tone"])").param_names(),
              (std::vector<std::string>{"hue", "key", "gain", "mode", "flag", "taps"}));
    EXPECT_EQ(sound(R"([])").modules.size(), 0U);
}

TEST_F(Modules, MayUseLightsForTheEffectsThatTakeThem) {
    EXPECT_FALSE(sound().uses_lights);
    write_module("tone", tone_module({{kModuleMore, R"("uses": ["lights"])"}}));
    const EffectManifest manifest = sound();
    ASSERT_TRUE(manifest.uses_lights);
    EXPECT_EQ(manifest.uses_lights->file, (glsl_ / "tone/module.json").string());
    // The effect may say so too.
    EXPECT_EQ(faults(nullptr, R"(["tone"], "uses": ["lights"])"), Lines{});
}

TEST_F(Modules, ThatAreNotThereAreNamedWithTheNearest) {
    EXPECT_EQ(faults(nullptr, R"(["toen", 3, "tone", "tone"])"),
              (Lines{"demo/effect.json:8: error: 'modules' holds strings, not an integer",
                     "demo/effect.json:8: error: 'modules' holds 'tone' twice",
                     "demo/effect.json:8: error: no module 'toen' in glsl; did you mean 'tone'?"}));
    // What would come from it is not reported as missing.
    EXPECT_EQ(faults(nullptr, R"(["tones"])", {{test::kPresets, R"("presets": {"strong": {"key": 3}})"}}),
              Lines{"demo/effect.json:8: error: no module 'tones' in glsl; did you mean 'tone'?"});
    EXPECT_EQ(faults(nullptr, R"("tone")"),
              Lines{"demo/effect.json:8: error: 'modules' must be an array, not a string"});
    EXPECT_EQ(faults(nullptr, R"(["../glsl/tone"])"),
              Lines{"demo/effect.json:8: error: no module '../glsl/tone' in glsl"});
}

TEST_F(Modules, TellBothPlacesOfANameThatIsDeclaredAgain) {
    write_module(
        "tone",
        tone_module({{kModuleParams,
                      R"("params": {"gain": {"type": "float", "unit": "m", "default": 1, "doc": "."}})"},
                     {kModuleTextures, R"("textures": {"small": {"format": "r32f", "doc": "."}})"},
                     {kModulePasses, R"("passes": [{"name": "one", "shader": "tone.frag",
                                  "reads": ["color"], "writes": ["small"], "buffers": {"sums": "atomic"}}])"}}));
    EXPECT_EQ(
        faults(),
        (Lines{
            "demo/effect.json:4: error: parameter 'gain' is declared already by the module 'tone' "
            "(glsl/tone/module.json:2)",
            "demo/effect.json:5: error: texture 'small' is declared already by the module 'tone' "
            "(glsl/tone/module.json:3)",
            "demo/effect.json:6: error: pass 'one': another pass has this name (glsl/tone/module.json:5)"}));
}

TEST_F(Modules, TellBothPlacesOfANameThatTwoThingsHaveInGlsl) {
    EXPECT_EQ(
        faults(
            nullptr, R"(["tone"])",
            {{test::kInputs,
              R"("inputs": {"color": {"role": "color"}, "depth": {"role": "depth"}, "tone": {"role": "mask"}})"},
             {test::kPasses, R"("passes": [
            {"name": "one", "shader": "a.frag", "reads": ["color", "depth", "tone"], "writes": ["small"]},
            {"name": "two", "shader": "b.frag", "reads": ["small"], "writes": ["color"]}])"}}),
        Lines{"glsl/tone/module.json:3: error: texture 'tone' needs the GLSL name 'tone', which the input "
              "'tone' (demo/effect.json:2) has"});
}

TEST_F(Modules, OfOneNameInTwoModulesIsAFaultOfTheSecond) {
    write_module("tone_too", R"({"aftershade": 1, "module": "tone_too", "summary": ".",
"params": {"key": {"type": "float", "default": 0, "doc": "."}},
"buffers": {"sums": {"element": "uint", "count": 4, "clear": 0, "doc": "."}}})");
    EXPECT_EQ(faults(nullptr, R"(["tone", "tone_too"])"),
              (Lines{"glsl/tone_too/module.json:2: error: parameter 'key' is declared already by the module "
                     "'tone' (glsl/tone/module.json:2)",
                     "glsl/tone_too/module.json:3: error: buffer 'sums' is declared already by the module "
                     "'tone' (glsl/tone/module.json:4)"}));
}

TEST_F(Modules, TellTheirOwnFaultsInTheirOwnLines) {
    EXPECT_EQ(
        faults_of_module({{kModuleHead, R"("aftershade": 2, "module": "Tone")"},
                          {kModuleMore, R"("presets": {}, "pases": [])"}}),
        (Lines{
            "glsl/tone/module.json:1: error: document version 2 is not known; this program reads version 1",
            "glsl/tone/module.json:1: error: the module 'Tone' must be snake_case: a-z, 0-9 and _, "
            "beginning with a letter",
            "glsl/tone/module.json:1: error: the module has no 'summary'",
            "glsl/tone/module.json:6: error: the module has no key 'presets'",
            "glsl/tone/module.json:6: error: the module has no key 'pases'; did you mean 'passes'?",
            "glsl/tone/module.json:1: error: the module 'Tone' is not the name of its folder, 'tone'"}));
    write_module("tone", "[]");
    EXPECT_EQ(faults(), Lines{"glsl/tone/module.json:1: error: the module must be an object, not an array"});
    write_module("tone", "{");
    ASSERT_EQ(faults().size(), 1U);
    EXPECT_TRUE(faults()[0].starts_with("glsl/tone/module.json:")) << faults()[0];
}

TEST_F(Modules, NameTheEffectThatLacksWhatTheyRead) {
    EXPECT_EQ(faults_of_module({{kModulePasses, R"("passes": [{"name": "tone", "shader": "tnoe.frag",
                  "reads": ["colour"], "writes": ["tone"], "buffers": {"sums": "atomic"}}])"}}),
              (Lines{"glsl/tone/module.json:5: error: pass 'tone' of the module 'tone' in 'demo': no file "
                     "'tnoe.frag' in glsl/tone",
                     "glsl/tone/module.json:5: error: pass 'tone' of the module 'tone' in 'demo': reads "
                     "'colour', which is neither an input nor a texture; did you mean 'color'?"}));
}

TEST_F(Modules, AreFoundByARegistryOfEffectsFromElsewhere) {
    effect_.write("effect.json", demo_manifest({{test::kMore, R"("modules": ["tone"])"}}));
    EffectRegistry effects({effect_.path().parent_path()}, glsl_.path());
    Diagnostics diagnostics;
    ASSERT_NE(effects.find("demo", diagnostics), nullptr);
    EXPECT_NE(effects.find("demo", diagnostics)->find_param("key"), nullptr);
    // Without a folder of modules: the shipped ones.
    effect_.write("effect.json", demo_manifest({{test::kMore, R"("modules": ["tone"])"}}));
    EffectRegistry shipped({effect_.path().parent_path()});
    EXPECT_EQ(shipped.find("demo", diagnostics), nullptr);
    ASSERT_EQ(diagnostics.error_count(), 1);
    EXPECT_EQ(diagnostics.all()[0].message.find("no module 'tone' in " AFTERSHADE_SOURCE_DIR "/glsl"), 0U);
}

}  // namespace
}  // namespace aftershade
