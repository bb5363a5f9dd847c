#include "framework/effect/usage_check.h"
#include "framework/effect/manifest/manifest_reader.h"

#include "tests/effect/assembly.h"

namespace aftershade {
namespace {

using test::demo_manifest;
using test::EffectFolder;
using test::Lines;

const std::filesystem::path kSourceTree = AFTERSHADE_SOURCE_DIR;

const std::string kFirst = R"(#version 450 core
#include <pass>
void main() {
    out_small = texelFetch(color, ivec2(0), 0) * param.gain;
#ifdef HAS_DEPTH
    out_small.a = texelFetch(depth, ivec2(0), 0).r;
#endif
}
)";
const std::string kSecond = R"(#version 450 core
#include <pass>
#include "mode.glsl"
void main() { out_color = mode() * small_size.x + textureLod(color, vec2(0), 0) * float(param.taps); }
)";
const std::string kMode = R"(vec4 mode() {
#if MODE == MODE_GOOD
    return vec4(param.flag);
#else
    return vec4(0);
#endif
}
)";

/// An effect whose shaders use all that it declares.
struct Sound {
    explicit Sound(const test::Sections& sections = {}) : folder(demo_manifest(sections)) {
        folder.write("a.frag", kFirst);
        folder.write("b.frag", kSecond);
        folder.write("mode.glsl", kMode);
    }
    /// As "file:line:column: error: message", without folders.
    Lines faults() const {
        Diagnostics diagnostics;
        const EffectManifest manifest = folder.sound_manifest();
        check_declared_used(manifest, kSourceTree / "glsl", diagnostics);
        Lines lines;
        for (const std::string& line : test::lines_of(diagnostics))
            lines.push_back(line.substr(folder.path().string().size() + 1));
        return lines;
    }
    EffectFolder folder;
};

TEST(UsageCheck, IsContentWhereAllIsUsed) {
    EXPECT_EQ(Sound().faults(), Lines{});
}

TEST(UsageCheck, IsContentWithTheEffectsThatShip) {
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kSourceTree / "effects")) {
        if (!std::filesystem::exists(entry.path() / "effect.json")) continue;
        Diagnostics faults;
        const auto node = read_document(entry.path() / "effect.json", faults);
        const auto manifest = node ? parse_manifest(*node, entry.path(), faults) : std::nullopt;
        if (manifest) check_declared_used(*manifest, kSourceTree / "glsl", faults);
        EXPECT_EQ(test::lines_of(faults), Lines{});
        ++count;
    }
    EXPECT_GT(count, 0);
}

TEST(UsageCheck, RefusesToSampleWhatIsReadByThePixel) {
    const Sound effect({{test::kInputs, R"("inputs": {"color": {"role": "color"}})"},
                        {test::kTextures, R"("textures": {})"},
                        {test::kPasses, R"("passes": [{"name": "only", "shader": "a.frag",
                            "reads": [{"color": "pixel"}], "writes": ["color"]}])"}});
    const auto faults_with = [&](const std::string& main) {
        effect.folder.write("a.frag", "#version 450 core\n#include <pass>\n" + main + "\n");
        Lines faults;
        for (const std::string& line : effect.faults())
            if (line.find("by the pixel") != line.npos) faults.push_back(line);
        return faults;
    };
    EXPECT_EQ(faults_with("void main() { out_color = color; }"), Lines{});
    EXPECT_EQ(faults_with("void main() { out_color = texelFetch(color, ivec2(1), 0); }"),
              (Lines{"a.frag:3:38: error: pass 'only' reads 'color' by the pixel: it is the texel itself, no "
                     "sampler; write 'color', or read it without \"pixel\""}));
    ASSERT_EQ(faults_with("void main() { out_color = dFdx(color); }").size(), 1u);
    ASSERT_EQ(faults_with("void main() { out_color = texelFetch(aftershade_texels_of_color, ivec2(1), 0); }")
                  .size(),
              1u);
}

TEST(UsageCheck, NamesTheLineOfWhatIsNotDeclared) {
    Sound effect;
    effect.folder.write("mode.glsl",
                        "float f() {\n    return param.gian + 1.0;\n}\nvec4 mode() { return vec4(param.mode, "
                        "native.x, MODE, param.flag); }\n");
    EXPECT_EQ(
        effect.faults(),
        (Lines{"mode.glsl:2:12: error: 'param.gian' is not a parameter of the effect; did you mean 'gain'?",
               "mode.glsl:4:27: error: 'param.mode' is bound as a define: write 'MODE'",
               "mode.glsl:4:39: error: 'native.x' is not declared in 'native'"}));
    effect.folder.write("mode.glsl", kMode);
    effect.folder.write(
        "b.frag",
        kSecond + "void more() { out_colour = vec4(1); vec3 out_way = vec3(0); out_way.x = 1.0; }\n");
    EXPECT_EQ(effect.faults(), Lines{"b.frag:5:15: error: 'out_colour' is not a target of a pass with this "
                                     "shader; did you mean 'out_color'?"});
}

TEST(UsageCheck, NamesThePlaceOfWhatIsNotUsed) {
    Sound effect;
    effect.folder.write(
        "a.frag",
        "#version 450 core\n#include <pass>\nvoid main() { out_small = texelFetch(color, ivec2(0), 0); }\n"
        "// depth, param.gain\n/* depth\n param.gain */\n");
    Lines lines = effect.faults();
    ASSERT_EQ(lines.size(), 2U) << ::testing::PrintToString(lines);
    EXPECT_TRUE(lines[0].starts_with("effect.json:6:") &&
                lines[0].ends_with("error: pass 'one': 'a.frag' does not use its read 'depth'"))
        << lines[0];
    EXPECT_TRUE(lines[1].starts_with("effect.json:4:") &&
                lines[1].ends_with("error: no shader uses 'param.gain'"))
        << lines[1];
    effect.folder.write("a.frag", kFirst);
    effect.folder.write("mode.glsl", "vec4 mode() { return vec4(param.flag); }\n");
    effect.folder.write("b.frag",
                        "#version 450 core\n#include <pass>\n#include \"mode.glsl\"\nvoid main() { small; "
                        "color; mode(); param.taps; }\n");
    lines = effect.faults();
    ASSERT_EQ(lines.size(), 2U) << ::testing::PrintToString(lines);
    EXPECT_TRUE(lines[0].ends_with("error: pass 'two': 'b.frag' does not use its target 'out_color'"))
        << lines[0];
    EXPECT_TRUE(lines[1].ends_with("error: no shader uses 'MODE'")) << lines[1];
}

/// The faults of the sound effect whose second shader ends with these statements, in which `light` is a vec4.
Lines faults_with_statements(const std::string& statements) {
    Sound effect;
    effect.folder.write("b.frag",
                        "#version 450 core\n#include <pass>\n#include \"mode.glsl\"\n"
                        "void put(out vec4 to) { to = vec4(0); }\nvoid main() {\n"
                        "    vec4 light = mode() * small_size.x * textureLod(color, vec2(0), 0);\n"
                        "    light *= float(param.taps);\n    " +
                            statements + "\n}\n");
    return effect.faults();
}

TEST(UsageCheck, RefusesATargetThatItsShaderOnlyReads) {
    for (const char* reads : {"light = out_color;", "if (out_color == light) discard;",
                              "light += out_color.rgbr;", "light = light + out_color;"}) {
        const Lines lines = faults_with_statements(reads);
        ASSERT_EQ(lines.size(), 1U) << reads << ::testing::PrintToString(lines);
        EXPECT_NE(lines[0].find("pass 'two': 'b.frag' has 'out_color' but assigns nothing to it"),
                  std::string::npos)
            << lines[0];
    }
    for (const char* writes :
         {"out_color = light;", "out_color.rgb = light.rgb;", "out_color[1] += light.g;", "put(out_color);",
          "light = out_color = light;", "++out_color;", "out_color--;"})
        EXPECT_EQ(faults_with_statements(writes), Lines{}) << writes;
}

TEST(UsageCheck, RefusesVariablesThatAreReadButNeverAssigned) {
    const std::string kWrites = " out_color = light;";
    for (const char* reads :
         {"float at[4]; light *= at[int(light.x)];", "vec4 more; light += more;",
          "mat2 turn; light.xy = turn * light.xy;", "int at[2], to[3]; light.x = float(at[to[1]]);"}) {
        const Lines lines = faults_with_statements(reads + kWrites);
        ASSERT_EQ(lines.size(), 1U) << reads << ::testing::PrintToString(lines);
        EXPECT_NE(lines[0].find("is read, but nothing is assigned to it"), std::string::npos) << lines[0];
    }
    for (const char* sound :
         {"float at[4]; at[int(light.x)] = 1.0; light *= at[0];", "vec4 more; put(more); light += more;",
          "vec4 more; more.xy = light.zw; light += more;",
          "int to[3], at[2]; to[at[1]++] = 2; light.x = float(to[0]);",
          "float x; for (int i = 0; i < 3; ++i) { if (i == 1) x = 1.0; } light *= x;",
          "bool is_lit; is_lit = light.x > 0.0; if (is_lit) light *= 2.0;", "float unused;",
          "float more[2] = float[2](1.0, 2.0); light *= more[0];"})
        EXPECT_EQ(faults_with_statements(sound + kWrites), Lines{}) << sound;
}

TEST(UsageCheck, HoldsEffectsToWhetherTheyUseTheLights) {
    const auto faults = [](const std::string& shader, const std::string& uses) {
        Sound effect(uses.empty() ? test::Sections{} : test::Sections{{test::kMore, uses}});
        effect.folder.write("a.frag", shader);
        return effect.faults();
    };
    const std::string uses = R"("uses": ["lights"])";
    EXPECT_EQ(faults(kFirst, ""), Lines{});
    const Lines unused = faults(kFirst, uses);
    ASSERT_EQ(unused.size(), 1U);
    EXPECT_TRUE(unused[0].starts_with("effect.json:8:") && unused[0].ends_with("no shader uses 'lights'"))
        << unused[0];
    const std::string counts = std::string(kFirst) + "int more() {\n    return lights.count;\n}\n";
    EXPECT_EQ(faults(counts, uses), Lines{});
    const Lines undeclared = faults(counts, "");
    ASSERT_EQ(undeclared.size(), 1U);
    EXPECT_TRUE(
        undeclared[0].ends_with(":12: error: 'lights' is there only for effects with \"uses\": [\"lights\"]"))
        << undeclared[0];
    // A thing of the shader's own may have that name.
    EXPECT_EQ(faults(std::string(kFirst) + "vec3 more(vec3 lights) { return lights.xxx; }\n", ""), Lines{});
}

TEST(UsageCheck, CountsWhatTheManifestItselfUses) {
    // taps sizes a texture, flag and mode decide on a pass: no shader need speak of them.
    Sound effect(
        {{test::kParams, R"("params": {
            "gain": {"type": "float", "unit": "m", "default": 1, "min": 0, "max": 9, "doc": "."},
            "mode": {"type": "enum", "values": ["fast", "good"], "default": "fast", "bind": "define", "doc": "."},
            "flag": {"type": "bool", "default": false, "doc": "."},
            "taps": {"type": "int", "default": 3, "min": 2, "max": 9, "doc": "."}})"},
         {test::kTextures, R"("textures": {"small": {"format": "rgba16f", "tile": "taps", "doc": "."}})"},
         {test::kPasses, R"("passes": [
            {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"], "when": {"flag": true, "mode": "fast"}},
            {"name": "two", "shader": "b.frag", "reads": ["small"], "writes": ["color"]}])"}});
    effect.folder.write(
        "b.frag",
        "#version 450 core\n#include <pass>\nvoid main() { out_color = texelFetch(small, ivec2(0), 0); }\n");
    EXPECT_EQ(effect.faults(), Lines{});
}

TEST(UsageCheck, LooksAtImagesBuffersAndNativeValuesInEitherShader) {
    const test::Sections sections = {
        {test::kTextures, R"("textures": {"small": {"format": "r32ui", "clear": 0, "doc": "."}})"},
        {test::kMore, R"("buffers": {"list": {"element": "uint", "per": "pixel", "doc": "."}},
            "native": {"uniforms": {"warp": {"type": "vec3", "doc": "."}}, "tables": {"kernel": {"element": "vec2", "count": 64, "doc": "."}}})"},
        {test::kPasses, R"("passes": [
            {"name": "base", "kind": "copy", "from": "color", "to": "color"},
            {"name": "one", "kind": "compute", "shader": "c.comp", "reads": ["color", "depth"], "images": {"small": "atomic"},
             "buffers": {"list": "write"}, "dispatch": {"tile": 8}},
            {"name": "two", "shader": "b.frag", "vertex": "d.vert", "instances": {"of": "points", "count": 9},
             "buffers": {"list": "read"}, "defines": {"LIST": "list"}, "writes": ["color"]}])"}};
    Sound effect(sections);
    const std::string head = "#version 450 core\n#include <pass>\n";
    effect.folder.write(
        "c.comp",
        head + "void main() { imageAtomicAdd(small, color_size, depth); list[0] = native.warp; kernel; }\n");
    effect.folder.write("d.vert", head + "void main() { LIST[0]; }\n");
    effect.folder.write("b.frag", head + "void main() { out_color = vec4(0); }\n");
    EXPECT_EQ(effect.faults(), Lines{}) << "parameters may be for native code alone";
    effect.folder.write("d.vert", head + "void main() { }\n");
    effect.folder.write("c.comp", head + "void main() { color; depth; }\n");
    Lines ends;
    for (const std::string& line : effect.faults()) ends.push_back(line.substr(line.find("error: ") + 7));
    EXPECT_EQ(ends, (Lines{"pass 'one': 'c.comp' does not use its image 'small'",
                           "pass 'one': 'c.comp' does not use its buffer 'list'",
                           "pass 'two': 'b.frag' and 'd.vert' do not use its buffer 'list'",
                           "no shader uses 'native.warp'", "no shader uses the native table 'kernel'"}));
}

TEST(UsageCheck, SaysOnlyThatAShaderCannotBeRead) {
    Sound effect;
    effect.folder.write("b.frag", "#version 450 core\n#include <pass>\n#include \"none.glsl\"\n");
    const Lines lines = effect.faults();
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].starts_with("b.frag:3:1: error: cannot read ")) << lines[0];
}

}  // namespace
}  // namespace aftershade
